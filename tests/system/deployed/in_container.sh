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

tracker=$(pid_of tracker)
gateway=$(pid_of ingest_gateway)
kill -KILL "$tracker"
check "a killed service comes back" within 5 is_new tracker "$tracker"
check "alone" [ "$(pid_of ingest_gateway)" = "$gateway" ]
check "and is heard again" within 5 heartbeats_flow

tracker=$(pid_of tracker)
kill -STOP "$tracker"
check "a frozen service is ended by its watchdog and comes back" within 15 is_new tracker "$tracker"

roudi=$(pid_of roudi)
declare -A before
for service in "${services[@]}"; do before[$service]=$(pid_of "$service"); done
kill -KILL "$roudi"
check "a killed RouDi comes back" within 5 is_new roudi "$roudi"
for service in "${services[@]}"; do
  check "boresight-$service is started anew with it" within 10 is_new "$service" "${before[$service]}"
done
check "and the new domain works" within 10 heartbeats_flow

for fault in KILL STOP; do
  roudi=$(pid_of roudi)
  tracker=$(pid_of tracker)
  kill -$fault "$(broker)"
  check "RouDi behind its wrapper, SIG$fault: a new one is started" within 5 is_new roudi "$roudi"
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

# A service off the data path that is not ready in time costs nobody else. A drop-in replaces its program.
mkdir -p /run/systemd/system/boresight-health.service.d
printf '[Service]\nExecStart=\nExecStart=/bin/sleep 100\nTimeoutStartSec=1\n' \
  > /run/systemd/system/boresight-health.service.d/late.conf
systemctl daemon-reload
roudi=$(pid_of roudi)
systemctl --no-block restart boresight-health.service
restarted_thrice() { [ "$(systemctl show -P NRestarts boresight-health.service)" -ge 3 ]; }
check "a service off the data path that is not ready in time is started again" within 10 restarted_thrice
check "alone" [ "$(pid_of tracker)$(pid_of roudi)" = "$tracker$roudi" ]
rm -r /run/systemd/system/boresight-health.service.d
systemctl daemon-reload
systemctl restart boresight-health.service
check "with its own program it becomes active" within 10 systemctl is-active -q boresight-health.service

systemctl stop boresight.target
check "stopping the target leaves no process and no shared memory" within 10 nothing_left

echo $failed > /out/verdict
exit $failed
