# For scripts that test a check by mistakes that they plant: sourced.

failures=0

# must_be_refused MESSAGE COMMAND…: COMMAND must fail and say MESSAGE; else it counts as a failure.
must_be_refused() {
  local message=$1 output
  shift
  if output=$("$@" 2>&1); then
    echo "not found: '$message'"
    failures=$((failures + 1))
  elif [[ $output != *"$message"* ]]; then
    printf "instead of '%s' came\n%s\n" "$message" "$output"
    failures=$((failures + 1))
  fi
}

# plant MESSAGE: check_page, which the script declares, must refuse the page on standard input with that message.
plant() { must_be_refused "$1" check_page; }
