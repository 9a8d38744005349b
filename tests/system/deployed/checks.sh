# Sourced inside the booted system: what its tests ask of units and topics. `failed` becomes 1 with the first failed check.
failed=0
check() { # check WHAT COMMAND…
  local what=$1
  shift
  if "$@"; then echo "ok      $what"; else echo "FAILED  $what"; failed=1; fi
}
# within SECONDS COMMAND…: repeats COMMAND until it succeeds.
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -ge "$end" ] && return 1
    sleep 0.1
  done
}

services=(ingest_gateway alignment_estimator detection_corrector ghost_filter tracker health)
pid_of() { systemctl show -P MainPID "boresight-$1.service"; }
all_active() { ! systemctl is-active boresight-roudi "${services[@]/#/boresight-}" | grep -qvx active; }
# is_new SERVICE OLD_PID: true if the service runs as another process.
is_new() { systemctl is-active -q "boresight-$1.service" && [ "$(pid_of "$1")" != "$2" ]; }
# broker: RouDi itself, which the unit's main process runs as its child.
broker() { pgrep -P "$(pid_of roudi)"; }
# monitor VEHICLE SECONDS: the topics as JSON, read by a member of the group.
monitor() {
  nsenter -m -t "$(pid_of roudi)" runuser -u boresight-monitor -- boresight monitor --config /etc/boresight \
    --vehicle "$1" --json --duration "$2" 2>/dev/null
}
nothing_left() { [ -z "$(ls /dev/shm)" ] && ! pgrep -f '^/usr/lib/boresight/|iox-roudi' >/dev/null; }
