#!/bin/bash
# Checks the systemd units without a running systemd: no unknown key, no dangling reference, exposure at most 2.5.
# Exit code 77 (skipped) where systemd-analyze is missing.
set -u
source_dir=$1
units=$source_dir/deploy/systemd
command -v systemd-analyze >/dev/null || { echo "skipped: no systemd-analyze"; exit 77; }

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
mkdir -p "$tree"/usr/lib/systemd/system "$tree"/usr/lib/boresight "$tree"/usr/bin "$tree"/bin
cp -r "$units"/boresight* "$tree"/usr/lib/systemd/system/
for target in basic sysinit shutdown; do
  printf '[Unit]\nDescription=%s\n' "$target" > "$tree/usr/lib/systemd/system/$target.target"
done
names=()
for unit in "$units"/boresight*.service; do
  name=$(basename "$unit")
  names+=("$name")
  install -m 755 /bin/true "$tree/usr/lib/boresight/${name%.service}"
done
install -m 755 /bin/true "$tree/usr/bin/iox-roudi"
install -m 755 /bin/true "$tree/bin/sh"

failed=0
systemd-analyze verify --recursive-errors=no --man=no --root="$tree" boresight.target "${names[@]}" || failed=1
# The check itself must be able to fail.
printf '[Service]\nExecStart=/bin/sh\nNoSuchKey=yes\n' > "$tree/usr/lib/systemd/system/broken.service"
systemd-analyze verify --recursive-errors=no --man=no --root="$tree" broken.service 2>/dev/null &&
  { echo "verify accepts an unknown key"; failed=1; }
for name in "${names[@]}"; do
  report=$(systemd-analyze security --offline=true --threshold=25 --root="$tree" "$name" --no-pager)
  result=$?
  tail -n 1 <<< "$report"
  [ $result -eq 0 ] || { echo "$name: exposed beyond 2.5"; failed=1; }
done

# Every service of the catalogue has a unit, a user, and a writer group where it has a segment.
while read -r group; do
  grep -q "^m $group  *$group$" "$units/sysusers.conf" || { echo "sysusers.conf: nobody is in group $group"; failed=1; }
  grep -qx "User=$group" "$units/$group.service" || { echo "$group.service does not run as $group"; failed=1; }
  grep -q "$group.service" "$units/boresight.target" || { echo "boresight.target does not want $group"; failed=1; }
done < <(sed -n 's/^writer = "\(.*\)"$/\1/p' "$source_dir/deploy/roudi/roudi-deployed.toml")
# iceoryx lets RouDi's group write to every segment: nobody else may be in it, and RouDi runs in it.
grep -E '^(m|u) ' "$units/sysusers.conf" | grep -vE '^u boresight-roudi ' | grep -E '[ :]boresight-roudi( |$)' |
  grep -v '^m boresight-roudi  *boresight$' && { echo "sysusers.conf: somebody else is in RouDi's group"; failed=1; }
grep -q '^u boresight-roudi .*:boresight-roudi ' "$units/sysusers.conf" || { echo "RouDi has no group of its own"; failed=1; }
grep -qx 'Group=boresight-roudi' "$units"/boresight-roudi.service.d/*.conf || { echo "RouDi does not run in its group"; failed=1; }
exit $failed
