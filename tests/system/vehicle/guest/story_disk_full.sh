# State and journal are on one small file system, which is filled: a finding, and nothing else is lost.
before=$(processes)
# As root, so that the blocks that ext4 reserves for root are used, too.
cat /dev/zero > /small/fill 2>/dev/null
check "the small file system is full" sh -c '! echo x > /small/one'
when=$(now_ms)
ip link set vcan1 down
timed "a fault on a full disk is reported" 2000 silent 3 "$when"
ip link set vcan1 up
timed "the full disk is in the fault memory" 10000 health_knows fault_memory_unwritable failed
when=$(now_ms)
timed "track lists flow" 2000 flows "$when"
timed "radar 3 delivers" 5000 delivers 3 "$when"
check "no process was restarted" [ "$(processes)" = "$before" ]
rm -f /small/fill /small/one
timed "with space again, the test passes" 20000 health_knows fault_memory_unwritable passed
