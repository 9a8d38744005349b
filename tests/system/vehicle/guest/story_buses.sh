# A bus goes down and comes back; only its radars are missing meanwhile.
before=$(processes)
link_fault() { # link_fault LINK RADAR OTHER_RADAR
  local when
  when=$(now_ms)
  ip link set "$1" down
  timed "$1 down: radar $2 is NO_DATA" 2000 silent "$2" "$when"
  check "radar $3 delivers all the same" delivers "$3" "$when"
  when=$(now_ms)
  ip link set "$1" up
  timed "$1 up: radar $2 delivers" 5000 delivers "$2" "$when"
}
link_fault vcan1 3 1
link_fault ecu0 1 3
for frame in 7FF#00 301#0011223344556677 300##1FFFFFFFF 301##1FF; do cansend vcan1 "$frame"; done
sleep 2
check "frames of strangers, too short and with false content, cost nothing" delivers 3 $(($(now_ms) - 3000))
check "no process was restarted" [ "$(processes)" = "$before" ]
timed "the silence of the CAN FD radar is in the fault memory" 10000 stored no_data
