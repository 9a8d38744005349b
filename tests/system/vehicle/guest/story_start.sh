# The installation, as deploy/systemd/README.md describes it; then every service is up and tracks flow.
systemd-sysusers
systemd-tmpfiles --create boresight.conf
/lib/systemd/systemd-sysctl 50-boresight.conf
check "the vehicle is chosen by its name" boresight vehicle use vehicle_test
scale_time_outs
begin_start=$(now_ms)
systemctl enable -q --now --no-block boresight.target
timed "every unit is active" 2000 all_active
timed "track lists flow" 5000 flows "$begin_start"
for radar in 1 2 3; do timed "radar $radar delivers" 5000 delivers "$radar" "$begin_start"; done
{ monitor vehicle_test 300 > /out/monitor.txt; } 2>/dev/null &
disown
sees_the_car() { grep -q '"confirmed":true,"movement":"moving"' /out/monitor.txt; }
timed "the car ahead is a confirmed moving track" 10000 sees_the_car
pkill -TERM -f "boresight monitor"
misaligned() { radar_is 3 "$begin_start" '"extended_qualifier":"MISALIGNED"'; }
timed "the misaligned CAN FD radar is MISALIGNED" 20000 misaligned
check "and no other" sh -c "! grep -E '\"radar_id\":[12],' $observed | grep -q MISALIGNED"
