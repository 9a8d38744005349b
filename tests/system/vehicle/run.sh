#!/usr/bin/env bash
# run.sh SOURCE_DIR BUILD_DIR: boots the deployed system in an emulated vehicle; README.md describes it.
# Exit code 0: every story passed; 1: one failed, or the guest gave no verdict; 2: not possible here.
set -euo pipefail
source_dir=$1
build=$2
here=$source_dir/tests/system/vehicle
work=$build/vehicle
# Of all boots together. A hang ends the test, not the patience of the one who waits.
limit_s=${BORESIGHT_VEHICLE_LIMIT_S:-3000}
# Stories of the first boot, separated by commas; empty: all of them.
stories=${BORESIGHT_VEHICLE_STORIES:-}
memory_mb=2048
# canplayer repeats the drive.
drive_s=300
boots=3
refuse() { echo "tests/run vehicle: $*" >&2; exit 2; }

if [ "${3:-}" != inside ]; then
  [ "$(id -u)" -eq 0 ] || refuse "mounting the guest's root tree needs root"
  for tool in qemu-system-x86_64 mksquashfs cpio depmod modprobe mkfs.ext4 canplayer cansend; do
    PATH=$PATH:/sbin:/usr/sbin command -v "$tool" >/dev/null || refuse "$tool is not installed (deploy/packages.txt, group vehicle)"
  done
  unshare -m true 2>/dev/null || refuse "no mount namespaces here"
  export PATH=$PATH:/sbin:/usr/sbin
  # All mounts below are in a separate namespace and end with it.
  exec unshare -m --propagation private "$0" "$source_dir" "$build" inside
fi
say() { printf '==> %s\n' "$*"; }

# unpack PACKAGE: downloads the Debian package and unpacks it to $work/packages/PACKAGE; installs nothing.
unpack() {
  local to=$work/packages/$1
  [ -d "$to" ] && return 0
  say "downloading $1"
  rm -rf "$work/download"
  mkdir -p "$work/download"
  (cd "$work/download" && { apt-get download -qq "$1" || { apt-get update -qq && apt-get download -qq "$1"; }; }) \
    > "$work/download.txt" 2>&1 || { cat "$work/download.txt"; refuse "apt-get cannot download $1"; }
  dpkg -x "$work"/download/*.deb "$to.new"
  mv "$to.new" "$to"
  rm -rf "$work/download"
}
mkdir -p "$work/packages"
kernel_package=$(apt-cache depends linux-image-amd64 2>/dev/null | sed -n 's/^ *Depends: \(linux-image-[0-9].*\)/\1/p' | head -n 1)
[ -n "$kernel_package" ] || { apt-get update -qq; kernel_package=$(apt-cache depends linux-image-amd64 | sed -n 's/^ *Depends: \(linux-image-[0-9].*\)/\1/p' | head -n 1); }
[ -n "$kernel_package" ] || refuse "apt knows no linux-image-amd64"
version=${kernel_package#linux-image-}
unpack "$kernel_package"
unpack busybox-static
kernel=$work/packages/$kernel_package/boot/vmlinuz-$version

out=$work/out
rm -rf "$out"
mkdir -p "$out"
say "logs: $out"

# KVM is used if a kernel gets as far as its first line with it. /dev/kvm alone proves nothing on nested machines.
accelerator=(-accel tcg -cpu max)
name="emulation (TCG)"
if [ -r /dev/kvm ] && [ -w /dev/kvm ]; then
  # In a shell of its own, which does not report an emulator that aborts.
  (timeout 10 qemu-system-x86_64 -accel kvm -cpu host -m 256 -nodefaults -display none -no-reboot -kernel "$kernel" \
    -serial "file:$out/kvm.txt" -append "console=ttyS0 panic=-1" || true) </dev/null >/dev/null 2>&1
  if grep -aq "Linux version" "$out/kvm.txt" 2>/dev/null; then accelerator=(-accel kvm -cpu host); name="KVM"; fi
fi
say "kernel $version, $name, load of this machine $(cut -d' ' -f1 /proc/loadavg)"

# shellcheck source=../deployed/root_tree.sh
source "$source_dir/tests/system/deployed/root_tree.sh"
made=0
make_root_tree "$work/memory" "$build" || made=$?
[ $made -ne 1 ] || refuse "no overlay file systems here"
[ $made -eq 0 ] || exit 1
root=$work/memory/root
# Services of System V scripts would start, too.
rm -rf "$root"/etc/rc?.d/*
# systemd takes a machine with this file for a container.
rm -f "$root/.dockerenv" "$root/var/lib/dbus/machine-id"
install -D -m 644 -t "$root/usr/local/lib/boresight-test" "$source_dir/tests/system/deployed/checks.sh" "$here"/guest/*.sh
install -m 644 -t "$root/etc/systemd/system" "$here"/guest/*.service
install -D -m 644 "$here/vehicle.toml" "$root/etc/boresight/vehicle/vehicle_test.toml"
mkdir -p "$root/var/lib/vehicle-feed" "$root/etc/systemd/system/multi-user.target.wants"
"$here/can_feed.py" $drive_s > "$root/var/lib/vehicle-feed/can.log"
for unit in "$here"/guest/*.service; do
  ln -s "/etc/systemd/system/$(basename "$unit")" "$root/etc/systemd/system/multi-user.target.wants/"
done
# The same work on this machine and in the guest gives the factor of emulation.
bash "$here/guest/work.sh" > "$out/work_s.txt"

# What the guest needs of the tree, as one file: thousands of small requests to a shared folder take minutes on a busy machine.
# Uncompressed, as the emulated processor would have to decompress it.
mksquashfs "$root" "$work/root.squashfs" -noappend -quiet -no-progress -no-exports -noI -noD -noF -noX -wildcards \
  -p "dev d 755 0 0" -p "proc d 555 0 0" -p "sys d 555 0 0" -p "run d 755 0 0" -p "tmp d 1777 0 0" -p "root d 700 0 0" \
  -p "out d 755 0 0" -p "small d 755 0 0" -p "var/log d 755 0 0" -p "var/tmp d 1777 0 0" -e \
  '!(bin|sbin|lib|lib32|lib64|libx32|etc|usr|var)' 'usr/!(bin|sbin|lib|lib32|lib64|libx32|share|local)' \
  'usr/lib/!(systemd|udev|sysusers.d|tmpfiles.d|sysctl.d|boresight|locale|os-release|*-linux-gnu)' \
  'usr/share/!(boresight|dbus-1|terminfo)' 'usr/local/!(lib)' 'usr/local/lib/!(boresight-test)' \
  'var/!(lib)' 'var/lib/!(vehicle-feed)' '... *.a' > "$out/squashfs.txt" 2>&1 || { cat "$out/squashfs.txt"; exit 1; }
"$here/initramfs.sh" "$work/packages/$kernel_package" "$version" "$work/packages/busybox-static/bin/busybox" "$work/initramfs.cpio"
truncate -s 0 "$work/disk.raw" "$work/small.raw"
truncate -s 2G "$work/disk.raw"
truncate -s 64M "$work/small.raw"
mkfs.ext4 -q -F "$work/disk.raw"
mkfs.ext4 -q -F "$work/small.raw"

# Nothing of the machine's own start is needed but the basic system.
masked=(
  getty.target timers.target systemd-firstboot.service ldconfig.service systemd-hwdb-update.service
  systemd-journal-catalog-update.service systemd-update-done.service systemd-machine-id-commit.service
  systemd-logind.service systemd-udevd.service systemd-udevd-kernel.socket systemd-udevd-control.socket
  systemd-udev-trigger.service systemd-udev-settle.service systemd-networkd.service systemd-networkd.socket
  systemd-resolved.service systemd-timesyncd.service systemd-random-seed.service systemd-network-generator.service
  systemd-binfmt.service systemd-update-utmp.service systemd-update-utmp-runlevel.service systemd-pstore.service
  e2scrub_reap.service dev-hugepages.mount dev-mqueue.mount sys-kernel-debug.mount sys-kernel-tracing.mount
  proc-sys-fs-binfmt_misc.automount kmod-static-nodes.service systemd-modules-load.service
)
for module in configfs dm_mod drm efi_pstore fuse loop; do masked+=("modprobe@$module.service"); done
append="console=ttyS0 quiet panic=-1 mitigations=off fstab=no luks=no systemd.unit=multi-user.target"
[ -z "$stories" ] || append+=" boresight.stories=$stories"
append+=" systemd.show_status=0 systemd.journald.forward_to_console=0 boresight.work_s=$(cat "$out/work_s.txt")"
for unit in "${masked[@]}"; do append+=" systemd.mask=$unit"; done

touch "$out/log.txt"
tail -n +1 -F "$out/log.txt" 2>/dev/null &
follower=$!
trap 'kill $follower 2>/dev/null || true' EXIT
end=$((SECONDS + limit_s))
status=0
for boot in $(seq $boots); do
  left=$((end - SECONDS))
  [ $left -gt 0 ] || break
  # -no-reboot: QEMU ends where a real machine would reset, and is started again with the same disks.
  timeout -k 5 "$left" qemu-system-x86_64 "${accelerator[@]}" -M q35 -smp 2 -m $memory_mb -nodefaults -display none -no-reboot \
    -serial "file:$out/console.$boot.txt" -monitor none -kernel "$kernel" -initrd "$work/initramfs.cpio" \
    -drive "file=$work/root.squashfs,format=raw,if=virtio,readonly=on" \
    -fsdev "local,id=out,path=$out,security_model=none" -device virtio-9p-pci,fsdev=out,mount_tag=out \
    -drive "file=$work/disk.raw,format=raw,if=virtio,cache=unsafe" -drive "file=$work/small.raw,format=raw,if=virtio,cache=unsafe" \
    -append "$append boresight.boot=$boot" </dev/null > "$out/qemu.$boot.txt" 2>&1 || status=$?
  [ -e "$out/reboots.$boot" ] || break
done
sleep 1
kill $follower 2>/dev/null || true

if [ "$(cat "$out/verdict" 2>/dev/null)" = 0 ]; then
  say "every story passed, $SECONDS s"
  exit 0
fi
if [ ! -e "$out/verdict" ]; then
  [ $SECONDS -lt $end ] && why="the guest ended early" || why="stopped after $limit_s s"
  say "no verdict: $why (boot $boot, QEMU $status); the end of its console:"
  tail -n 5 "$out/console.$boot.txt" 2>/dev/null || true
fi
grep '^FAILED' "$out/log.txt" || true
say "failed after $SECONDS s; log, journals, diagnostics and consoles: $out"
exit 1
