# Runs the stories of this boot; the host starts the machine again if they asked for it.
set -u
here=/usr/local/lib/boresight-test
boot=$(sed -n 's/.*boresight\.boot=\([0-9]*\).*/\1/p' /proc/cmdline)
# shellcheck source=../../deployed/checks.sh
source "$here/checks.sh"
# shellcheck source=judge.sh
source "$here/judge.sh"
journalctl -b -f -n all -o short-monotonic > "/out/journal.$boot.txt" &
[ ! -e /out/failed ] || failed=1
echo "==> boot $boot: $(uname -r), $(systemd-analyze time 2>/dev/null | head -n 1 || true)"
# shellcheck source=/dev/null
source "$here/boot_$boot.sh"
