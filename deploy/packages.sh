# Sourced by deploy/demo and tests/run: installs what is missing of deploy/packages.txt.

if [ -t 1 ]; then say() { printf '\033[1m==>\033[0m %s\n' "$*"; }; else say() { printf '==> %s\n' "$*"; }; fi

# install_packages GROUP…: does nothing where everything is there, so that it needs no root then.
install_packages() {
  local file group missing=() package as_root=()
  file=$(dirname "${BASH_SOURCE[0]}")/packages.txt
  if ! command -v dpkg-query >/dev/null; then
    say "this is not a Debian system: make sure that the packages of deploy/packages.txt are there"
    return 0
  fi
  for group in "$@"; do
    for package in $(sed -n "s/^$group: //p" "$file"); do
      dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
    done
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { say "missing packages, and no root to install them: ${missing[*]}"; return 1; }
    as_root=(sudo)
  fi
  say "installing ${#missing[@]} packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -qq
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" \
    > /dev/null
}

# configure BUILD_DIR [option…]: CMake, quiet unless it fails.
configure() {
  local build=$1 log
  shift
  mkdir -p "$build"
  log=$build/configure.log
  cmake -G Ninja -S "$(dirname "${BASH_SOURCE[0]}")/.." -B "$build" "$@" > "$log" 2>&1 || { cat "$log"; return 1; }
}
