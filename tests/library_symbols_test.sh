#!/usr/bin/env bash
# What libkaustik shows, what it uses, and what it keeps: it exports the interface for hosts alone, its code neither prints nor
# ends the program nor handles signals, and it has no variables that last but constants that are made once. The check must find
# what is planted. Usage: library_symbols_test.sh LIBRARY COMPILER
set -euo pipefail
library=$1
compiler=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Prints what LIBRARY shows beside the interface.
wrong_exports() {
  nm -DC --defined-only "$1" | cut -d' ' -f2- |
    grep -vE '^A KAUSTIK_0' |
    grep -vE '^[TVRDW] ((typeinfo|typeinfo name|vtable) for )?kaustik::v0::[A-Z]|^T kaustik::v0::(version|operator|irradiance|radiance)|^T kaustik::v0::Array kaustik::v0::Array::' || true
  # What the interface is made of is no part of it.
  nm -DC --defined-only "$1" | grep -E 'kaustik::v0::details::[A-Za-z]+::' || true
}

# Prints what LIBRARY calls that belongs to the program which uses it.
wrong_calls() {
  nm -DC --undefined-only "$1" | awk '{ print $2 }' | sed 's/@.*//' |
    grep -xE '_?exit|abort|quick_exit|atexit|signal|sigaction|sigprocmask|raise|v?f?printf|__v?f?printf_chk|puts|fputs|putchar|perror|setlocale|setenv|putenv|std::(cout|cerr|clog|terminate)|stdout|stderr|stdin|getenv|secure_getenv|fork|system|chdir|umask' || true
}

# Prints variables of LIBRARY that lie beyond functions. Those of OpenEXR's headers are its own.
wrong_variables() {
  objdump -tC "$1" | awk '$4 == ".bss" || $4 == ".data" || $3 == ".bss" || $3 == ".data"' |
    sed -E 's/^.*\.(bss|data)[[:space:]]+[0-9a-f]+[[:space:]]+(\.hidden )?//' |
    grep -vE '\)( const)?(\[abi:[a-z0-9]+\])?::|^guard variable for |^DW\.ref\.|^completed\.|^__|^\.(bss|data)$|^std::__ioinit$|^Imf_' || true
}

complaints=0
complain() {
  [[ -z $2 ]] && return
  printf '%s:\n%s\n' "$1" "$2"
  complaints=$((complaints + 1))
}
complain "libkaustik shows more than its interface" "$(wrong_exports "$library")"
complain "libkaustik does what is the program's to do" "$(wrong_calls "$library")"
complain "libkaustik has variables that last" "$(wrong_variables "$library")"
shown=$(nm -DC --defined-only "$library")
for name in 'kaustik::v0::Session::run()' 'typeinfo for kaustik::v0::Error' 'kaustik::v0::version()'; do
  grep -qF -- "$name" <<<"$shown" || complain "libkaustik does not show" "$name"
done

cat >"$work/planted.cpp" <<'PLANTED'
#include <csignal>
#include <cstdio>
#include <cstdlib>
namespace kaustik {
int counter = 1;
void leak(int n) {
  std::signal(2, SIG_IGN);
  std::printf("%d", counter += n);
  if (std::getenv("KAUSTIK")) std::exit(1);
}
namespace v0::details { struct State { void work(); }; void State::work() { leak(1); } }
}
PLANTED
"$compiler" -shared -fPIC "$work/planted.cpp" -o "$work/planted.so"
expect() {
  grep -qF -- "$1" <<<"$2" || complain "a planted fault is not found" "$1 in: $2"
}
expect 'kaustik::leak(int)' "$(wrong_exports "$work/planted.so")"
expect 'kaustik::v0::details::State::work()' "$(wrong_exports "$work/planted.so")"
for call in signal printf getenv exit; do expect "$call" "$(wrong_calls "$work/planted.so")"; done
expect 'kaustik::counter' "$(wrong_variables "$work/planted.so")"
[[ $complaints == 0 ]] || exit 1
echo "library_symbols_test: passed"
