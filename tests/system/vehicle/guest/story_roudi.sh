# RouDi and its wrapper are killed, RouDi is stopped: the whole domain starts again.
for fault in "wrapper KILL" "RouDi KILL" "RouDi STOP"; do
  before=$(processes)
  when=$(now_ms)
  [ "${fault% *}" = wrapper ] && target=$(pid_of roudi) || target=$(broker)
  kill -"${fault#* }" "$target"
  timed "$fault: the domain is back and track lists flow" 2000 domain_back "$before" "$when"
done
