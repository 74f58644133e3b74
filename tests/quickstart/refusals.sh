#!/bin/sh
# What cmake/quickstart.sh says and does where it cannot go on. Stub commands stand in for the machine's own.
set -eu
cd "$(dirname "$0")/../.."
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

failures=0
fail() {
    echo "FAILED: $*"
    sed 's/^/    /' "$work/out"
    failures=$((failures + 1))
}

# machine <name> <command...>: a PATH of its own with these of the machine's commands, and no others.
machine() {
    bin="$work/$1"
    mkdir -p "$bin"
    shift
    for name in sh dirname env grep mkdir rm mv cat tar "$@"; do
        ln -sf "$(command -v "$name")" "$bin/$name"
    done
}

# stub <name>: a command made of standard input.
stub() {
    { echo '#!/bin/sh'; cat; } >"$bin/$1"
    chmod +x "$bin/$1"
}

# check <what> <exit code> <line that is said>: of quickstart with $arguments, in a copy of the source tree.
check() {
    code=0
    env -i PATH="$bin" LOG="$work/log" sh "$work/tree/cmake/quickstart.sh" $arguments >"$work/out" 2>&1 </dev/null || code=$?
    [ "$code" -eq "$2" ] || fail "$1: exit code $code instead of $2"
    grep -q -- "$3" "$work/out" || fail "$1: does not say '$3'"
}
mkdir -p "$work/tree/cmake"
cp cmake/quickstart.sh "$work/tree/cmake/"
: >"$work/log"

# An unknown command, or none.
machine bare
for arguments in "" "dem" "packages" "packages dem"; do
    check "command '$arguments'" 2 "^usage: sh cmake/quickstart.sh"
done

# A system without dpkg.
for arguments in demo test study performance; do
    check "$arguments without dpkg" 2 "^quickstart: expected Debian 12 or a system like it"
    [ "$(grep -c . "$work/out")" -eq 1 ] || fail "$arguments without dpkg: more than one line"
done

# Neither root nor sudo.
arguments=demo
machine not_root
stub id </dev/null
echo 'echo 1000' >>"$bin/id"
stub dpkg-query <<'END'
exit 1
END
stub apt-get <<'END'
echo "apt-get $*" >>"$LOG"
END
check "no root" 2 "^quickstart: installing packages needs root, and there is no sudo"
grep -q 'as root, run: apt-get update && apt-get install .* libcgal-dev' "$work/out" || fail "no root: does not say what to run"
[ "$(grep -c . "$work/out")" -eq 1 ] || fail "no root: more than one line"
[ ! -s "$work/log" ] || fail "no root: ran $(cat "$work/log")"

# With sudo, everything that needs root goes through it.
stub sudo <<'END'
echo "sudo $*" >>"$LOG"
exit 7
END
check "sudo that fails" 7 "^installing: "
[ "$(cat "$work/log")" = "sudo apt-get update -qq" ] || fail "sudo that fails: ran $(cat "$work/log")"
: >"$work/log"

# A package that does not exist, or a network that is not there: what apt-get says is seen, and nothing is built.
machine offline
stub id <<'END'
echo 0
END
stub dpkg-query <<'END'
exit 1
END
stub apt-get <<'END'
[ "$1" = update ] || { echo "E: Unable to locate package" >&2; exit 100; }
END
stub cmake <<'END'
echo "cmake $*" >>"$LOG"
END
check "apt-get that fails" 100 "^E: Unable to locate package"
[ ! -s "$work/log" ] || fail "apt-get that fails: ran $(cat "$work/log")"

# All packages are there, but no lists of packages, from which the surface is fetched: they are read first.
machine no_lists
stub id <<'END'
echo 0
END
stub dpkg-query <<'END'
echo 'install ok installed'
END
stub cmake </dev/null
stub dpkg-deb <<'END'
mkdir -p "$3/usr/share/doc/libcgal-demo/data/meshes"
cd "$3/usr/share/doc/libcgal-demo"
echo OFF >data/meshes/elephant.off
tar -cf data.tar data
mv data.tar data.tar.gz # the stub of tar reads it plainly
END
rm "$bin/tar"
stub tar <<END
if [ "\$1" = -xzOf ]; then shift; exec $(command -v tar) -xOf "\$@"; fi
exec $(command -v tar) "\$@"
END
stub apt-get <<'END'
echo "apt-get $*" >>"$LOG"
case "$1" in
update) : >"$LOG.lists" ;;
download) [ -f "$LOG.lists" ] || { echo "E: Can't find a source to download" >&2; exit 100; }; : >libcgal-demo_1_all.deb ;;
*) exit 1 ;;
esac
END
mkdir -p "$work/tree/build/bin"
printf '#!/bin/sh\nexit 0\n' >"$work/tree/build/bin/springfit"
chmod +x "$work/tree/build/bin/springfit"
check "no package lists" 0 "^fetching: elephant"
[ "$(grep -c 'apt-get update' "$work/log")" -eq 1 ] || fail "no package lists: apt-get update was not run once"
[ "$(cat "$work/tree/build/data/elephant.off" 2>/dev/null)" = OFF ] || fail "no package lists: no elephant"
! grep -q '^E:' "$work/out" || fail "no package lists: shows an error that was mended"

# Run again, it fetches and installs nothing.
: >"$work/log"
env -i PATH="$bin" LOG="$work/log" sh "$work/tree/cmake/quickstart.sh" demo >"$work/out" 2>&1 </dev/null || fail "run again: fails"
[ ! -s "$work/log" ] || fail "run again: ran $(cat "$work/log")"

[ "$failures" -eq 0 ] || exit 1
echo "quickstart refuses well"
