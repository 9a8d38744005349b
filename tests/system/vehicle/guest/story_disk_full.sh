# State and journal are on one small file system, which is filled: a finding, and nothing else is lost.
before=$(processes)
# As root, so that the blocks that ext4 reserves for root are used, too.
# Once it is full the journal gives old files up, so it is filled until nothing fits.
fill() {
  for _ in 1 2 3 4 5 6 7 8 9 10; do
    cat /dev/zero >> /small/fill 2>/dev/null
    sync
    echo x > /small/one || return 0
  done
  return 1
}
check "the small file system is full" fill
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
