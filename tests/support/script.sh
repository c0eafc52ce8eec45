# For tests that are scripts: sourced.

fail() {
  echo "$*" >&2
  exit 1
}

# until_true SECONDS WHAT COMMAND…: waits for COMMAND to succeed, and else fails by the name of WHAT.
until_true() {
  local end=$((SECONDS + $1)) what="$2: not within $1 s"
  shift 2
  until "$@"; do
    [[ $SECONDS -lt $end ]] || fail "$what"
    sleep 0.2
  done
}

# in_own_folder: goes to a new folder, $work, that ends with the script.
in_own_folder() {
  work=$(mktemp -d)
  trap 'rm -rf "$work"' EXIT
  cd "$work"
}
