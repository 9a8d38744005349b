# First boot: the product is installed and started as an integrator would, then suffers every fault.
echo "    emulation factor $(seconds $((factor_percent * 10))), $(nproc) processors, $(free -m | awk '/^Mem/ {print $2}') MB"
chosen=$(sed -n 's/.*boresight\.stories=\([a-z_,]*\).*/\1/p' /proc/cmdline)
chosen=${chosen:-services,roudi,buses,memory_limit,configuration,disk_full}
# shellcheck source=/dev/null
for story in start ${chosen//,/ }; do
  begin=$(now_ms)
  echo "==> $story"
  source "$here/story_$story.sh"
  echo "    $story took $(seconds $(($(now_ms) - begin))) s"
done
echo "==> reboot"
codes /out/codes.1.jsonl
restart_machine systemctl --no-block --job-mode=replace-irreversibly start reboot.target
