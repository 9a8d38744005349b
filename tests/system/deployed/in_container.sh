#!/usr/bin/env bash
# Runs as the only task of the booted container; README.md describes its checks.
set -u
# shellcheck source=checks.sh
source /usr/local/lib/boresight-test/checks.sh
heartbeats_flow() { monitor demo 2 | tail -n 1 | grep -q '"name":"tracker","condition":"\(alive\|degraded\|restarted\)"'; }

ip link set lo up multicast on
ip route add 224.0.0.0/4 dev lo

# refuses TEXT: a service finds no vehicle, ends with exit code 2 and says what to do.
refuses() {
  local said
  said=$(/usr/lib/boresight/boresight-ingest_gateway --check 2>&1)
  [ $? -eq 2 ] && [[ $said == *"$1"* ]]
}
check "no vehicle is chosen by the installation" refuses "choose one by 'boresight vehicle use"
check "an example is chosen by its name" boresight vehicle use demo
check "a vehicle that no service can use is refused" sh -c '! boresight vehicle use alignment_drive 2>/dev/null'

systemctl start boresight.target
check "every unit becomes active" within 15 all_active
for service in roudi "${services[@]}"; do
  check "boresight-$service runs as a user of its own" \
    [ "$(ps -o user:40= -p "$(pid_of "$service")")" = "boresight-$service" ]
done

boresight diagnostics > /out/diagnostics.txt 2>&1 &
diagnostics=$!
systemctl start boresight-replay.service
monitor demo 24 > /out/monitor.txt
check "the replay played to its end" within 15 sh -c '! systemctl is-active -q boresight-replay.service'
check "the replay ended well" [ "$(systemctl show -P Result boresight-replay.service)" = success ]
kill -TERM $diagnostics
wait $diagnostics
check "a DDS subscriber reports the misaligned radar as degraded" grep -q 'front_right.*MISALIGNED' /out/diagnostics.txt
check "and no other" sh -c '! grep MISALIGNED /out/diagnostics.txt | grep -qE "front_left|rear_left|rear_right"'
check "the monitor shows tracks" grep -q '"confirmed":true' /out/monitor.txt
check "no scan is lost" sh -c '! grep -qE "\"lost\":[1-9]|\"input lost\"" /out/monitor.txt'

# mapped SERVICE SEGMENT ACCESS: access of the service to a segment of shared memory ("rw-s", "r--s").
mapped() { grep " /dev/shm/boresight-$2\$" "/proc/$(pid_of "$1")/maps" | awk '{print $2}' | sort -u | grep -qx -- "$3"; }
check "a service maps its own segment for writing" mapped tracker tracker rw-s
check "and the others' read-only" mapped tracker ghost_filter r--s

# in_domain USER COMMAND…: as a process of the domain, with this user's groups.
in_domain() {
  local user=$1
  shift
  nsenter -m -t "$(pid_of roudi)" runuser -u "boresight-$user" -- "$@"
}
# opens USER FILE ACCESS: whether the user can open the file for reading ("<") or for reading and writing ("<>").
opens() { in_domain "$1" sh -c "exec 3$3'$2'" 2>/dev/null; }
# only_writer SEGMENT: every user may read the segment; only its own service may open it for writing.
only_writer() {
  local user may
  for user in "${services[@]}" monitor replay; do
    opens "$user" "/dev/shm/boresight-$1" '<' || { echo "$user cannot read $1"; return 1; }
    may=no
    opens "$user" "/dev/shm/boresight-$1" '<>' && may=yes
    [ $may = "$([ "$user" = "$1" ] && echo yes || echo no)" ] || { echo "$user may write to $1: $may"; return 1; }
  done
}
for service in "${services[@]}"; do
  check "only $service may open its segment for writing" only_writer "$service"
done
stranger_is_shut_out() { ! setpriv --reuid nobody --regid nogroup --clear-groups sh -c 'exec 3</dev/shm/iceoryx_mgmt' 2>/dev/null; }
check "a user of another group may not open the management memory" stranger_is_shut_out
check "RouDi's wrapper sees for what RouDi waits" sh -c '! journalctl -b -u boresight-roudi | grep -q "does not show"'
has_no_capability() { ! grep -q '^CapEff:.*[1-9a-f]' "/proc/$(broker)/status"; }
check "RouDi has no capability" has_no_capability

# closed STATE: nobody but the service of this name can look into its folder of persisted state.
closed() {
  local user
  for user in "${services[@]}" monitor replay; do
    [ "$user" = "$1" ] && continue
    runuser -u "boresight-$user" -- ls "/var/lib/boresight/$1/" >/dev/null 2>&1 && { echo "$user looks into $1"; return 1; }
  done
  runuser -u "boresight-$1" -- ls "/var/lib/boresight/$1/" >/dev/null
}
check "only the estimator reaches its alignment memory" closed alignment_estimator
check "only health reaches the fault memory" closed health

# A compromised service that publishes in the gateway's name. RouDi lets it; the readers refuse its messages.
# refusals SERVICE: messages that this service refused.
refusals() {
  local count
  count=$(monitor demo 1 | tail -n 1 | grep -o "\"name\":\"$1\"[^}]*\"foreign memory\":[0-9]*" | grep -o '[0-9]*$')
  echo "${count:-0}"
}
check "the readers refused no message so far" [ "$(refusals detection_corrector)" = 0 ]
# fails_with ERROR USER ARGUMENT…: the impostor ends with this error of the middleware.
fails_with() {
  local error=$1 user=$2
  shift 2
  in_domain "$user" deployed-impostor "$@" > "/out/impostor_$user.txt" 2>&1
  [ $? -eq 70 ] && grep -q "$error" "/out/impostor_$user.txt"
}
check "the monitor may publish nothing" fails_with NO_WRITABLE_SHM_SEGMENT monitor small
check "radar scans of the tracker end it: its memory has no room for them" fails_with CHUNK_IS_TOO_LARGE tracker
check "vehicle motions of the tracker enter the queues" in_domain tracker deployed-impostor small
check "and the corrector refuses them" [ "$(refusals detection_corrector)" -ge 20 ]
refused=$(refusals detection_corrector)
check "radar scans of the ghost filter enter the queues" in_domain ghost_filter deployed-impostor
check "and the corrector refuses them" [ "$(refusals detection_corrector)" -ge $((refused + 20)) ]
check "the true gateway goes on" heartbeats_flow

tracker=$(pid_of tracker)
gateway=$(pid_of ingest_gateway)
kill -KILL "$tracker"
check "a killed service comes back" within 5 is_new tracker "$tracker"
check "alone" [ "$(pid_of ingest_gateway)" = "$gateway" ]
check "and is heard again" within 5 heartbeats_flow
# alive SERVICE: the monitor hears its heartbeats.
alive() { monitor demo 1 | tail -n 1 | grep -q "\"name\":\"$1\",\"condition\":\"\(alive\|degraded\|restarted\)\""; }
for service in "${services[@]}"; do
  old=$(pid_of "$service")
  kill -KILL "$old"
  check "$service, killed, comes back" within 10 is_new "$service" "$old"
  check "and is heard again by users of other groups" within 10 alive "$service"
done

tracker=$(pid_of tracker)
kill -STOP "$tracker"
check "a frozen service is ended by its watchdog and comes back" within 15 is_new tracker "$tracker"

roudi=$(pid_of roudi)
declare -A before
for service in "${services[@]}"; do before[$service]=$(pid_of "$service"); done
kill -KILL "$roudi"
check "a killed RouDi comes back" within 10 is_new roudi "$roudi"
for service in "${services[@]}"; do
  check "boresight-$service is started anew with it" within 10 is_new "$service" "${before[$service]}"
done
check "and the new domain works" within 10 heartbeats_flow

for fault in KILL STOP; do
  roudi=$(pid_of roudi)
  tracker=$(pid_of tracker)
  kill -$fault "$(broker)"
  check "RouDi behind its wrapper, SIG$fault: a new one is started" within 10 is_new roudi "$roudi"
  check "with the domain" within 10 is_new tracker "$tracker"
  check "which works" within 10 heartbeats_flow
done

# A broken configuration. Replaced at once, as an editor does.
configuration=/etc/boresight/services/ghost_filter.toml
cp "$configuration" /tmp/whole.toml
{ cat "$configuration"; echo '[nonsense]'; } > "$configuration.new"
mv "$configuration.new" "$configuration"
tracker=$(pid_of tracker)
kill -TERM "$(pid_of ghost_filter)"
check "a service with a broken configuration fails" within 5 systemctl is-failed -q boresight-ghost_filter.service
restarts=$(systemctl show -P NRestarts boresight-ghost_filter.service)
sleep 1
check "and is not tried again" [ "$(systemctl show -P NRestarts boresight-ghost_filter.service)" = "$restarts" ]
check "the others go on" [ "$(pid_of tracker)" = "$tracker" ]
cp /tmp/whole.toml "$configuration"
systemctl start boresight-ghost_filter.service
check "mended, it is started by hand" within 5 systemctl is-active -q boresight-ghost_filter.service

# A service on the data path that is not ready in time restarts the domain, also if every command takes a second. Drop-ins
# replace its program, and the path on which the unit finds systemctl.
mkdir -p /run/systemd/system/boresight-tracker.service.d
printf '[Service]\nExecStart=\nExecStart=/bin/sleep 100\nTimeoutStartSec=1\nEnvironment=PATH=%s:/usr/bin:/bin\n' \
  /usr/local/lib/boresight-test/slow > /run/systemd/system/boresight-tracker.service.d/late.conf
systemctl daemon-reload
roudi=$(pid_of roudi)
gateway=$(pid_of ingest_gateway)
systemctl --no-block restart boresight-tracker.service
check "a service on the data path that is not ready in time restarts RouDi on a slow machine, too" \
  within 15 is_new roudi "$roudi"
check "and with it the domain" within 10 is_new ingest_gateway "$gateway"
# Stopped as a whole: a command of the last failure may still run.
systemctl stop boresight.target
rm -r /run/systemd/system/boresight-tracker.service.d
systemctl daemon-reload
systemctl start boresight.target
check "with its own program the domain works" within 15 alive tracker

# A service off the data path that is not ready in time costs nobody else. A drop-in replaces its program.
mkdir -p /run/systemd/system/boresight-health.service.d
printf '[Service]\nExecStart=\nExecStart=/bin/sleep 100\nTimeoutStartSec=1\n' \
  > /run/systemd/system/boresight-health.service.d/late.conf
systemctl daemon-reload
roudi=$(pid_of roudi)
tracker=$(pid_of tracker)
systemctl --no-block restart boresight-health.service
restarted_thrice() { [ "$(systemctl show -P NRestarts boresight-health.service)" -ge 3 ]; }
check "a service off the data path that is not ready in time is started again" within 10 restarted_thrice
check "alone" [ "$(pid_of tracker)$(pid_of roudi)" = "$tracker$roudi" ]
rm -r /run/systemd/system/boresight-health.service.d
systemctl daemon-reload
systemctl restart boresight-health.service
check "with its own program it becomes active" within 10 systemctl is-active -q boresight-health.service

# A monitor that is still registered: RouDi may not end it.
in_domain monitor boresight monitor --config /etc/boresight --vehicle demo --json --duration 60 > /dev/null 2>&1 &
sleep 1
systemctl stop boresight.target
check "stopping the target leaves no process and no shared memory" within 10 nothing_left
check "though a monitor was registered" pkill -u boresight-monitor

echo $failed > /out/verdict
exit $failed
