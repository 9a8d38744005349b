# Sourced on the host by the tests that boot the deployed system: makes the root tree of a separate machine.

# make_root_tree MEMORY BUILD: a copy-on-write view of this machine's root with the product of BUILD installed, as
# MEMORY/root. MEMORY becomes a file system in memory, which holds what is changed. Call it in a mount namespace of its own.
# Exit code 1: no overlay file systems here; 2: the installation failed.
make_root_tree() {
  local memory=$1 build=$2 root=$1/root
  mkdir -p "$memory"
  mount -t tmpfs tmpfs "$memory" || return 1
  mkdir "$memory/upper" "$memory/work" "$root"
  mount -t overlay overlay -o "lowerdir=/,upperdir=$memory/upper,workdir=$memory/work" "$root" 2>/dev/null || return 1
  # A separate machine: none of the host's services, another identity. An empty file: not "uninitialized", which makes the
  # next boot the first one, and the first boot enables every installed unit.
  : > "$root/etc/machine-id"
  rm -rf "$root"/etc/systemd/system/*.wants
  DESTDIR=$root cmake --install "$build" --prefix /usr > "$memory/install.txt" 2>&1 || { cat "$memory/install.txt"; return 2; }
}
