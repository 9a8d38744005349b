#!/usr/bin/env bash
# run.sh SOURCE_DIR BUILD_DIR: see README.md. Exit code 77: not possible here.
set -euo pipefail
source_dir=$1
build=$2
here=$source_dir/tests/system/deployed
skip() { echo "skipped: $*"; exit 77; }

if [ "${3:-}" != inside ]; then
  [ "$(id -u)" -eq 0 ] || skip "booting a container needs root"
  command -v systemd-nspawn >/dev/null || skip "no systemd-nspawn (package systemd-container)"
  [ -x /lib/systemd/systemd ] || skip "this machine has no systemd to boot"
  unshare -m true 2>/dev/null || skip "no mount namespaces here"
  # All mounts below are in a separate namespace and end with it.
  exec unshare -m --propagation private "$0" "$source_dir" "$build" inside
fi

work=$build/deployed
rm -rf "$work/out"
mkdir -p "$work/out"
root=$work/memory/root
# shellcheck source=root_tree.sh
source "$here/root_tree.sh"
made=0
make_root_tree "$work/memory" "$build" || made=$?
[ $made -ne 1 ] || skip "no overlay file systems here"
[ $made -eq 0 ] || exit 1

nspawn=(systemd-nspawn --quiet --directory="$root" --machine="boresight-$$" --register=no --keep-unit
        --private-network --console=pipe)
"${nspawn[@]}" /bin/true </dev/null >"$work/out/preflight.txt" 2>&1 ||
  skip "systemd-nspawn does not work here: $(tail -n 1 "$work/out/preflight.txt")"

"$build/bin/boresight" simulate --vehicle "$source_dir/config/vehicle/demo.toml" --duration 25 \
  --out "$root/var/lib/boresight-drive" > "$work/out/simulate.txt"
recordings=$(find "$root/var/lib/boresight-drive" \( -name '*.log' -o -name '*.pcap' \) -printf '/var/lib/boresight-drive/%f ')
cat > "$root/etc/default/boresight" <<EOF
BORESIGHT_INPUT=replay
BORESIGHT_REPLAY_ARGS=$recordings
EOF
install -D -m 644 -t "$root/usr/local/lib/boresight-test" "$here/checks.sh"
install -m 755 "$here/in_container.sh" "$root/usr/local/bin/deployed-test"
install -d "$root/usr/local/lib/boresight-test/slow"
printf '#!/bin/sh\nsleep 1\nexec /usr/bin/systemctl "$@"\n' > "$root/usr/local/lib/boresight-test/slow/systemctl"
chmod 755 "$root/usr/local/lib/boresight-test/slow/systemctl"
install -m 755 "$build/bin/deployed_impostor" "$root/usr/local/bin/deployed-impostor"
cat > "$root/etc/systemd/system/deployed-test.service" <<'EOF'
# Not named boresight-…, as the restrictions of these units would apply.
[Unit]
Description=The deployed test
[Service]
Type=oneshot
ExecStart=/usr/local/bin/deployed-test
ExecStopPost=/bin/sh -c 'journalctl -b --no-pager -o short-monotonic > /out/journal.txt; systemctl poweroff -ff'
StandardOutput=append:/out/log.txt
StandardError=inherit
EOF

timeout -k 5 200 "${nspawn[@]}" --boot --bind="$work/out:/out" systemd.unit=deployed-test.service \
  </dev/null >"$work/out/console.txt" 2>&1 || true
cat "$work/out/log.txt" 2>/dev/null || { cat "$work/out/console.txt"; echo "systemd did not get as far as the test"; exit 1; }
# Only the result written inside counts: a container that dies early has none.
[ "$(cat "$work/out/verdict" 2>/dev/null)" = 0 ] || { echo "journal: $work/out/journal.txt"; exit 1; }
