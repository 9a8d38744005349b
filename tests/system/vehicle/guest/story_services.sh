# Each service is killed and stopped: it alone comes back.
for service in "${services[@]}"; do
  for signal in KILL STOP; do
    old=$(pid_of "$service")
    others=$(processes "$service")
    when=$(now_ms)
    kill -"$signal" "$old"
    # A stopped service is ended by its watchdog of two seconds.
    [ $signal = KILL ] && bar=1000 || bar=4000
    timed "$service, SIG$signal: it is back and track lists flow" $bar back "$service" "$old" "$when"
    check "alone" [ "$(processes "$service")" = "$others" ]
  done
done
