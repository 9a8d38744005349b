# Third boot, after a power cut.
timed "every unit is active after the power cut" 5000 all_active
timed "track lists flow" 5000 flows 0
codes /out/codes.4.jsonl
check "every trouble code outlived the power cut" kept /out/codes.3.jsonl /out/codes.4.jsonl
check "no damaged state was found" sh -c '! ls /var/lib/boresight/*/*.rejected 2>/dev/null'
# The radars' server is a program of the product, and the observer has files in shared memory.
cp $observed "/out/diagnostics.$boot.jsonl"
systemctl stop vehicle-radars.service vehicle-diagnostics.service boresight.target
check "stopping the target leaves no process and no shared memory" within 60 nothing_left
echo $failed > /out/verdict
