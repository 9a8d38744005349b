# A broken configuration: exit code 2, a failed unit, no endless restart, and the others go on.
service=detection_corrector
unit=boresight-$service.service
others=$(processes $service)
configuration=/etc/boresight/services/$service.toml
cp $configuration /run/whole.toml
{ cat $configuration; echo '[nonsense]'; } > $configuration.new
mv $configuration.new $configuration
kill -TERM "$(pid_of $service)"
timed "$service with a broken configuration is a failed unit" 2000 systemctl is-failed -q $unit
check "with exit code 2" [ "$(systemctl show -P ExecMainStatus $unit)" = 2 ]
check "and its reason in the journal" sh -c "journalctl -q -b -u $unit -o cat | grep -q nonsense"
restarts=$(systemctl show -P NRestarts $unit)
sleep 10
check "it is not tried again" [ "$(systemctl show -P NRestarts $unit) $(systemctl is-failed $unit)" = "$restarts failed" ]
check "the others go on" [ "$(processes $service)" = "$others" ]
cp /run/whole.toml $configuration
when=$(now_ms)
systemctl start boresight.target
timed "mended and started by hand, it is back and track lists flow" 2000 back $service 0 "$when"
