#!/usr/bin/env bash
# run.sh SOURCE_DIR BUILD_DIR: the demo as a user runs it, in a namespace of its own: it reports the misaligned radar,
# passes, and leaves no process and no file behind, whether it ends by itself, by Ctrl-C, or is killed.
# Exit code 77: namespaces are not available.
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
# The checkout itself may lie in /tmp, so no tmpfs covers /tmp. Files that existed before are not counted; RouDi may
# remove some of them (locks of a killed RouDi).
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
check "the demo passes" [ $? -eq 0 ]
check "it reports the misaligned radar" grep -q '^  front_right: MISALIGNED, yaw +2\.[0-9]* ± [0-9.]*°' "$out/whole.txt"
check "it reports no other radar" [ "$(grep -c ': MISALIGNED' "$out/whole.txt")" -eq 1 ]
check "it states the estimation errors and NEES" \
  grep -Eq '^  front_right +[+-][0-9.e-]+ \([0-9.]+ σ\) +[+-]0\.[0-9]+° .* [0-9]+\.[0-9]{2} +[0-9]+\.[0-9]{2}$' "$out/whole.txt"
check "it compares the ghost filter with the truth" \
  grep -Eq '^  \[ok\] [0-9.]+ % of [0-9,]+ detections of moving objects were classified as moving' "$out/whole.txt"
# The aim is 90 %, and a live run scatters between 89 and 91 %. The page states the miss; far below is a failure.
check "it recognises ghosts of type 2" \
  grep -Eq '^  \[(ok|MISSED)\] (8[5-9]|9[0-9])\.[0-9] % of [0-9,]+ ghosts of type 2 were classified as ghosts' "$out/whole.txt"
# An aim that is missed on this drive: half of these ghosts lie where a part of their object could be.
check "it states how many ghosts of type 1 were classified as ghosts" \
  grep -Eq '^  \[(ok|MISSED)\] [0-9.]+ % of [0-9,]+ ghosts of type 1 were classified as ghosts' "$out/whole.txt"
check "every scan of the run is found in the truth" grep -Eq '^  \[ok\] ([0-9,]+) of \1 recorded scans were found' "$out/whole.txt"
check "it states how many tracks followed a ghost" grep -Eq '^  \[(ok|MISSED)\] no confirmed track followed a ghost' "$out/whole.txt"
check "its page shows labels, truth, and scans from above" \
  [ "$(grep -Ec 'classification of detections</h2>|comparison with the truth</h2>|Most detections classified as ghosts: at' "$out/whole/report.html")" -eq 3 ]
"$build/bin/boresight" score --config "$source_dir/config" "$out/whole/run" --truth "$out/whole/drive" > "$out/score.txt" 2>&1
check "its run folder can be scored" [ $? -eq 0 ]
check "every scan of it has a truth" grep -Eq '^Detections: [0-9,]+ scans judged, 0 without truth' "$out/score.txt"
check "and every track list" grep -Eq '^Tracks: [0-9,]+ lists judged, 0 without truth' "$out/score.txt"
"$build/bin/boresight" report --config "$source_dir/config" --vehicle demo "$out/whole/run" --truth "$out/whole/drive/truth.csv" \
  --out "$out/again.html" > "$out/again.txt" 2>&1
check "boresight report finds the same in it" diff <(sed -n '/latency of a scan/,/^  faults/p' "$out/whole.txt") \
  <(sed -n '/latency of a scan/,/^  faults/p' "$out/again.txt")
check "it writes a report" grep -q 'All checks passed' "$out/whole/report.html"
check "its summary is at most 60 lines" [ "$(sed -n '/^Summary of/,$p' "$out/whole.txt" | wc -l)" -le 60 ]
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
