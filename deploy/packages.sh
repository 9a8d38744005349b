# Sourced by deploy/demo and tests/run: installs what is missing of deploy/packages.txt, configures and builds.

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

# Shows ninja's progress: one line that changes on a terminal, a line for every tenth part elsewhere. Whatever else
# comes, such as a failed command with its messages, is passed on.
_show_progress() {
  local line tenth=-1 on_line=0
  while IFS= read -r line; do
    [[ $line != *Re-checking\ globbed* ]] || continue
    if [[ $line =~ ^@\ *([0-9]+)%\ ([0-9]+/[0-9]+)\ ([0-9]+) ]]; then
      if [ -t 1 ]; then
        printf '\r    %3d %%, %s steps, %d s' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "${BASH_REMATCH[3]}"
        on_line=1
      elif [ $((BASH_REMATCH[1] / 10)) -ne $tenth ]; then
        tenth=$((BASH_REMATCH[1] / 10))
        printf '    %3d %%, %s steps, %d s\n' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "${BASH_REMATCH[3]}"
      fi
    elif [[ $line != ninja:\ Entering* && $line != ninja:\ no\ work* ]]; then
      [ $on_line -eq 0 ] || { printf '\n'; on_line=0; }
      printf '%s\n' "$line"
    fi
  done
  [ $on_line -eq 0 ] || printf '\n'
}

# build_targets BUILD_DIR CPU_MINUTES [target…]: builds with progress. A first build takes about CPU_MINUTES on one core.
build_targets() {
  local build=$1 minutes cores
  cores=$(nproc)
  minutes=$((($2 + cores - 1) / cores))
  shift 2
  [ -f "$build/.ninja_log" ] || say "building for the first time: about $minutes minutes on $cores cores"
  NINJA_STATUS='@ %p %f/%t %e ' ninja -C "$build" "$@" 2>&1 | _show_progress
  return "${PIPESTATUS[0]}"
}
