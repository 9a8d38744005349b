#!/usr/bin/env bash
# run.sh SOURCE_DIR BUILD_DIR: the demo as a user runs it, in a namespace of its own: that it names the crooked radar and
# ends well, and that it leaves no process and no file behind, whether it ends by itself, by Ctrl-C, or is killed.
# Exit code 77: not possible here.
set -uo pipefail
source_dir=$1
build=$2
if [ "${3:-}" != inside ]; then
  # As root without a user namespace; else with one, where the kernel allows it.
  how=(unshare --mount --pid --fork --mount-proc --propagation private)
  "${how[@]}" true 2>/dev/null || how=("${how[@]}" --map-root-user)
  "${how[@]}" true 2>/dev/null || { echo "skipped: no namespaces here"; exit 77; }
  exec "${how[@]}" "$0" "$source_dir" "$build" inside
fi
mount -t tmpfs tmpfs /dev/shm
out=$build/demo_test
rm -rf "$out"
mkdir -p "$out"
# The checkout itself may lie in /tmp, so it is not covered; what was there before is remembered instead. Of that, RouDi
# removes the locks of one that was killed, so only what is new counts.
traces() { find /tmp -maxdepth 1 \( -name '*boresight-*' -o -name '*roudi*' \) | sort; }
before=$(traces)
new_traces() { comm -13 <(echo "$before") <(traces); }

failed=0
check() { # check WHAT COMMAND…
  local what=$1
  shift
  if "$@"; then echo "ok      $what"; else echo "FAILED  $what"; failed=1; fi
}
demo() { "$build/bin/boresight" demo --config "$source_dir/config" --out "$out/$1" "${@:2}"; }
processes() { pgrep -f "iox-roudi|boresight-|boresight (demo|monitor)" | grep -vx $$; }
nothing_left() {
  [ -z "$(ls -A /dev/shm)" ] && [ -z "$(new_traces)" ] && [ -z "$(processes)" ]
}
within() { # within SECONDS COMMAND…
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -ge "$end" ] && return 1
    sleep 0.1
  done
}
playing() { pgrep -f "$build/bin/boresight-replay" >/dev/null; }

demo whole --duration 25 > "$out/whole.txt" 2>&1
check "the demo ends well" [ $? -eq 0 ]
check "it names the crooked radar" grep -q '^  front_right: MISALIGNED, yaw +2\.[0-9]*° ± ' "$out/whole.txt"
check "it names no other" [ "$(grep -c ': MISALIGNED' "$out/whole.txt")" -eq 1 ]
check "it states errors and NEES against the truth" \
  grep -Eq '^  front_right +[+-][0-9.e-]+ \([0-9.]+ σ\) +[+-]0\.[0-9]+° .* [0-9]+\.[0-9]{2} +[0-9]+\.[0-9]{2}$' "$out/whole.txt"
for what in '[0-9]+ detections of moving objects [0-9.]+ % were told to be moving' \
            '[0-9]+ ghosts of type 1 [0-9.]+ % were told to be ghosts' \
            '[0-9]+ ghosts of type 2 [0-9.]+ % were told to be ghosts'; do
  check "it judges the ghost filter by the truth: of $what" grep -Eq "^  \[ok\] of $what" "$out/whole.txt"
done
check "every scan of the run is found in the truth" grep -Eq '^  \[ok\] ([0-9]+) of \1 recorded scans were found' "$out/whole.txt"
check "it says how many tracks lived on ghosts" grep -Eq '^  \[(ok|MISSED)\] no track lived on ghosts' "$out/whole.txt"
check "its page shows labels, truth, and scans from above" \
  [ "$(grep -Ec 'told to be</h2>|against the truth</h2>|Most ghosts told: at' "$out/whole/report.html")" -eq 3 ]
check "it writes a report" grep -q 'Everything worked' "$out/whole/report.html"
check "it leaves nothing behind" nothing_left
[ $failed -eq 0 ] || cat "$out/whole.txt"

demo interrupted > "$out/interrupted.txt" 2>&1 &
pid=$!
check "a second one plays" within 20 playing
sleep 1
kill -INT "$(pgrep -f -o 'boresight demo')"
wait $pid
check "Ctrl-C ends it with 130" [ $? -eq 130 ]
check "and leaves nothing behind" nothing_left

demo killed > "$out/killed.txt" 2>&1 &
check "a third one plays" within 20 playing
kill -KILL "$(pgrep -f -o 'boresight demo')"
check "killed, it leaves nothing behind either" within 6 nothing_left
exit $failed
