#!/usr/bin/env bash
# initramfs.sh KERNEL_TREE VERSION BUSYBOX OUT: writes the guest's first file system to OUT. It loads the kernel modules,
# mounts the guest's root and starts systemd. The root is a copy of the host's (/dev/vda), below the overlay of a disk
# (/dev/vdb), which therefore outlives a reboot. A small disk (/dev/vdc) holds the state of the services and the journal.
# The host shares one folder, /out, for the results.
set -euo pipefail
tree=$1
version=$2
busybox=$3
out=$4
modules=(virtio_pci virtio_blk 9pnet_virtio 9p squashfs overlay ext4 vcan can_raw veth)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work"/{bin,proc,sys,dev,lower,disk,root,modules}
cp "$busybox" "$work/bin/busybox"
depmod -b "$tree" "$version"
for module in "${modules[@]}"; do
  modprobe -d "$tree" -S "$version" --show-depends "$module" | sed -n 's/^insmod \([^ ]*\).*/\1/p'
done | awk '!seen[$0]++' | while read -r file; do
  cp "$file" "$work/modules/"
  basename "$file" >> "$work/modules/order"
done

cat > "$work/init" <<'EOS'
#!/bin/busybox sh
# Every failure ends the machine, without a verdict.
b=/bin/busybox
give_up() { $b echo "initramfs: $*"; $b poweroff -f; }
$b mount -t proc proc /proc
$b mount -t sysfs sys /sys
$b mount -t devtmpfs dev /dev
while read -r module; do $b insmod "/modules/$module" || $b echo "initramfs: no $module"; done < /modules/order
$b mount -t squashfs -o ro /dev/vda /lower || give_up "no root tree"
$b mount -t ext4 /dev/vdb /disk || give_up "no disk"
$b mkdir -p /disk/upper /disk/work
$b mount -t overlay -o lowerdir=/lower,upperdir=/disk/upper,workdir=/disk/work overlay /root || give_up "no overlay"
$b mkdir -p /root/out /root/small
$b mount -t 9p -o trans=virtio,version=9p2000.L,msize=512000,cache=none out /root/out || give_up "no folder for results"
$b mount -t ext4 /dev/vdc /root/small || give_up "no small disk"
$b mkdir -p /root/small/state /root/small/journal /root/var/lib/boresight /root/var/log/journal
$b mount -o bind /root/small/state /root/var/lib/boresight
$b mount -o bind /root/small/journal /root/var/log/journal
$b echo "initramfs: starts systemd at $($b cut -d' ' -f1 /proc/uptime) s"
$b umount /proc /sys
$b mount -o move /dev /root/dev
exec $b switch_root /root /lib/systemd/systemd
EOS

chmod +x "$work/init"
(cd "$work" && find . | cpio -o -H newc --quiet) > "$out"
