# Sourced in the guest: times with their bars, and what health publishes.

# The factor of emulation in hundredths: the time of the same work here and on the host.
factor_percent=$(
  host=$(sed -n 's/.*boresight\.work_s=\([0-9.]*\).*/\1/p' /proc/cmdline)
  here=$(bash /usr/local/lib/boresight-test/work.sh)
  awk -v here="$here" -v host="$host" 'BEGIN { f = 100 * here / host; print int(f < 100 ? 100 : f) }'
)
emulated() { [ "$factor_percent" -ge 200 ]; }
# A slow guest on a busy host: no time below this is judged there. In milliseconds.
patience_ms=120000
# Between two looks. Each costs an emulated processor tenths of a second.
emulated && pause_s=0.5 || pause_s=0.05

# scale_time_outs: the units' time-outs are those of a real machine; an emulated one gets each times the factor. Written to
# the disk, so that later boots have them, too.
scale_time_outs() {
  emulated || return 0
  mkdir -p /etc/systemd/system/boresight-.service.d
  {
    echo '[Service]'
    echo "WatchdogSec=$((2000 * factor_percent / 100))ms"
    echo "TimeoutStartSec=$((10000 * factor_percent / 100))ms"
    echo "TimeoutStopSec=$((10000 * factor_percent / 100))ms"
    echo "TimeoutAbortSec=$((500 * factor_percent / 100))ms"
    echo "Environment=BORESIGHT_STOP_LIMIT_MS=$((500 * factor_percent / 100))"
    echo "Environment=BORESIGHT_ROUDI_ASLEEP_LIMIT_MS=$((500 * factor_percent / 100))"
    echo "Environment=BORESIGHT_ROUDI_STARVED_LIMIT_MS=$((2500 * factor_percent / 100))"
    echo "Environment=BORESIGHT_ROUDI_BUSY_LIMIT_MS=$((2000 * factor_percent / 100))"
  } > /etc/systemd/system/boresight-.service.d/50-emulated.conf
  systemctl daemon-reload
}
now_ms() { echo $((${EPOCHREALTIME/[.,]/} / 1000)); }
seconds() { printf '%d.%d' $(($1 / 1000)) $(($1 % 1000 / 100)); }

# timed WHAT BAR_MS COMMAND…: waits for COMMAND and prints the time it took. The bar holds for a real machine. An emulated
# one gets the bar times the factor of emulation, and at least the patience.
timed() {
  local what=$1 bar=$2 limit=$2 begin end
  shift 2
  if emulated; then
    limit=$((bar * factor_percent / 100))
    [ $limit -ge $patience_ms ] || limit=$patience_ms
  fi
  begin=$(now_ms)
  until "$@"; do
    if [ $(($(now_ms) - begin)) -ge $limit ]; then
      echo "FAILED  $what: not within $(seconds $limit) s (bar $(seconds "$bar") s)"
      failed=1
      return 1
    fi
    sleep "$pause_s"
  done
  end=$(now_ms)
  echo "ok      $what: $(seconds $((end - begin))) s (bar $(seconds "$bar") s, judged here: $(seconds $limit) s)"
}

# --- what health publishes ------------------------------------------------------------------------------------------
observed=/run/diagnostics.jsonl
# latest PATTERN: the newest sample with it.
latest() { tail -n 200 $observed 2>/dev/null | grep -- "$1" | tail -n 1; }
stamp_ms() { [[ $1 =~ \"time_ns\":([0-9]+) ]] && echo $((BASH_REMATCH[1] / 1000000)) || echo 0; }
# flows SINCE_MS: health reported after that time that track lists arrive for the scans of the radars.
flows() {
  local sample
  sample=$(latest '"overall"')
  [ "$(stamp_ms "$sample")" -gt "$1" ] && [[ $sample != *'"pipeline":{"data_qualifier":"NOT_AVAILABLE"'* ]]
}
# radar_is ID SINCE_MS TEXT: the newest report on the radar is younger than that time and contains TEXT.
radar_is() {
  local sample
  sample=$(latest "\"radar_id\":$1,")
  [ "$(stamp_ms "$sample")" -gt "$2" ] && [[ $sample == *"$3"* ]]
}
delivers() { radar_is "$1" "$2" '"data_qualifier":"AVAILABLE'; }
silent() { radar_is "$1" "$2" '"extended_qualifier":"NO_DATA"'; }

# --- processes ------------------------------------------------------------------------------------------------------
# processes [BUT]: the services' names with their process ids, without that of BUT.
processes() {
  local service
  for service in roudi "${services[@]}"; do [ "$service" = "${1:-}" ] || echo "$service $(pid_of "$service")"; done
}
# back SERVICE OLD_PID SINCE_MS: the service runs as another process, and track lists flow.
back() { is_new "$1" "$2" && flows "$3"; }
# domain_back OLD_PROCESSES SINCE_MS: every service runs as another process, and track lists flow.
domain_back() {
  local service pid
  while read -r service pid; do is_new "$service" "$pid" || return 1; done <<< "$1"
  flows "$2"
}
# codes FILE: the trouble codes in the stored fault memory, as lines of JSON.
codes() {
  boresight dtc list --json --config /etc/boresight --vehicle vehicle_test --state /var/lib/boresight/health/fault_memory \
    > "$1" 2> "$1.txt"
}
has_code() { grep -q "\"name\":\"$2\"" "$1"; }
stored() { codes /run/codes.jsonl && has_code /run/codes.jsonl "$1"; }
# health_knows CODE WORD: health lists the code over DDS, with that word in its status. A full disk cannot store it.
health_knows() {
  boresight dtc list --json --config /etc/boresight --seconds 30 > /out/known.jsonl 2> /out/known.txt &&
    grep "\"name\":\"$1\"" /out/known.jsonl | grep -q "\"status_words\":\"[^\"]*$2"
}

# kept BEFORE AFTER: every trouble code of BEFORE is in AFTER, with as many occurrences or more, and the same first freeze
# frame. Prints those that are not.
facts() { sed -nE 's/.*"code":"([^"]*)".*"occurrences":([0-9]+).*"first":\{"time_ns":([0-9]+).*/\1 \2 \3/p' "$1"; }
kept() {
  [ -s "$1" ] || return 1
  awk '
    NR == FNR { occurrences[$1] = $2; first[$1] = $3; before++; next }
    { after++ }
    $1 in first && $2 >= occurrences[$1] && $3 == first[$1] { delete first[$1] }
    END {
      for (code in first) { print "        " code " is lost, or not as it was"; lost++ }
      print "        " before + 0 " codes before, " after + 0 " after"
      exit !(before > 0 && lost == 0)
    }' <(facts "$1") <(facts "$2")
}

# restart_machine HOW…: leaves the verdict so far for the next boot and restarts.
restart_machine() {
  cp $observed "/out/diagnostics.$boot.jsonl"
  [ $failed -eq 0 ] || touch /out/failed
  touch "/out/reboots.$boot" /run/restarting
  "$@"
  sleep infinity
}
