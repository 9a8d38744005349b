# Second boot: the services start with the machine, and their memory is that of the first boot.
begin_boot=$(now_ms)
timed "every unit is active after the reboot" 5000 all_active
timed "track lists flow" 5000 flows 0
timed "radar 3 delivers" 5000 radar_is 3 0 '"extended_qualifier":"MISALIGNED"'
check "the misaligned radar was AVAILABLE in no report since the boot" \
  sh -c "! grep '\"radar_id\":3,' $observed | grep -q '\"data_qualifier\":\"AVAILABLE\"'"
codes /out/codes.2.jsonl
# What the first boot stored is there: code and number of occurrences, or more.
check "every trouble code outlived the reboot" kept /out/codes.1.jsonl /out/codes.2.jsonl
echo "==> power cut"
when=$(now_ms)
ip link set vcan1 down
timed "radar 3 is NO_DATA" 2000 silent 3 "$when"
sleep 1 # the file is written at once; the bar is one second
codes /out/codes.3.jsonl
sync -f /out/codes.3.jsonl
restart_machine sh -c 'echo 1 > /proc/sys/kernel/sysrq; echo b > /proc/sysrq-trigger'
