# A service meets its limit of memory: the kernel kills it, systemd starts it again, the others live.
service=ghost_filter
unit=boresight-$service.service
others=$(processes $service)
old=$(pid_of $service)
when=$(now_ms)
systemctl set-property --runtime $unit MemoryMax=$(($(systemctl show -P MemoryCurrent $unit) / 4))
killed() { journalctl -q -b -u $unit -o cat | grep -q 'oom-kill'; }
timed "beyond MemoryMax the kernel kills $service" 5000 killed
systemctl set-property --runtime $unit MemoryMax=infinity
timed "with enough memory it is back and track lists flow" 2000 back $service "$old" "$(now_ms)"
check "the others live" [ "$(processes $service)" = "$others" ]
