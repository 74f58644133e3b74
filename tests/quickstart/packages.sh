#!/bin/sh
# sh tests/quickstart/packages.sh <command> <preset>: what the command's preset finds on this machine belongs to the packages
# that the command installs, or to those that they need. Needs no network.
# Exit code 77: not checkable here, since not all of these packages are installed.
set -eu
cd "$(dirname "$0")/../.."
command="$1"
preset="$2"

command -v dpkg-query >/dev/null || { echo "not checkable: no dpkg here"; exit 77; }
packages="$(sh cmake/quickstart.sh packages "$command")"
missing=""
for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
if [ -n "$missing" ]; then
    echo "$command: not checkable, not installed:$missing"
    exit 77
fi

work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
trap 'exit 130' INT TERM

# Configured as on a bare machine: what lies outside of packages is not found.
if ! env -i HOME="$work" PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    cmake --preset "$preset" -B "$work/build" -DCMAKE_IGNORE_PREFIX_PATH=/usr/local >"$work/log" 2>&1; then
    cat "$work/log"
    echo "$command: the preset $preset does not configure" >&2
    exit 1
fi

dpkg-query -W -f '${db:Status-Status}\t${Package}\t${Priority}\t${Essential}\t${Provides}\t${Pre-Depends}\t${Depends}\n' |
    sed -n 's/^installed\t//p' | awk -v wanted="$packages" -f tests/quickstart/owners.awk | sort >"$work/allowed"

# Each path that was found, with the name of its cache entry, and likewise what it links to, step by step.
hops() {
    path="$(realpath -s "$2")"
    while :; do
        printf '%s\t%s\n' "$1" "$path"
        [ -L "$path" ] || break
        target="$(readlink "$path")"
        case "$target" in
        /*) path="$(realpath -s "$target")" ;;
        *) path="$(realpath -s "$(dirname "$path")/$target")" ;;
        esac
    done
}
sed -n 's/^\([A-Za-z0-9_.+-]*\):[A-Z]*=\(\/.*\)$/\1 \2/p' "$work/build/CMakeCache.txt" |
    while read -r entry paths; do
        case "$entry" in
        *INSTALL_PREFIX | CMAKE_HOME_DIRECTORY | CMAKE_CACHEFILE_DIR | CMAKE_IGNORE_PREFIX_PATH) continue ;;
        esac
        echo "$paths" | tr ';' '\n' | while read -r path; do
            case "$path" in
            "$work"* | "$PWD" | "$PWD"/*) continue ;;
            /*) [ ! -e "$path" ] || hops "$entry" "$path" ;;
            esac
        done
    done | sort -u >"$work/found"
if [ "$(grep -c . "$work/found")" -lt 10 ]; then
    cat "$work/found"
    echo "$command: the preset $preset found nearly nothing; this test reads its cache wrongly" >&2
    exit 1
fi

# Path and package of all that is owned. Packages may have put it into /lib where it now is in /usr/lib.
cut -f 2 "$work/found" | sort -u >"$work/paths"
sed -n 's|^/usr/|/|p' "$work/paths" | sort -u - "$work/paths" >"$work/names"
xargs dpkg-query -S <"$work/names" 2>/dev/null | grep -v '^diversion' >"$work/owners" || true

# A link that a package's script made (alternatives) is nobody's; what it leads to must be somebody's.
awk -F '\t' -v command="$command" -v preset="$preset" '
    FILENAME ~ /allowed$/ { allowed[$1] = 1; next }
    FILENAME ~ /owners$/ {
        at = match($0, /: \//)
        path = substr($0, at + 2)
        n = split(substr($0, 1, at - 1), names, /,[ ]*/)
        for (i = 1; i <= n; ++i) {
            sub(/:.*/, "", names[i])
            owners[path] = owners[path] " " names[i]
        }
        next
    }
    {
        path = $2
        short = path
        sub(/^\/usr/, "", short)
        own = owners[path] (short == path ? "" : owners[short])
        n = split(own, names, " ")
        good = 0
        for (i = 1; i <= n; ++i) {
            good = good || (names[i] in allowed)
        }
        if (n == 0 && system("test -L \"" path "\"") != 0) {
            print command ": " $1 " found " path ", which no package owns"
            failures++
        } else if (n > 0 && !good) {
            print command ": " $1 " found " path " of the package" own ", which \"sh cmake/quickstart.sh " command \
                "\" does not install"
            failures++
        }
    }
    END {
        if (failures > 0) {
            print command ": add the packages to cmake/quickstart.sh, or keep the preset " preset " from looking for them"
            exit 1
        }
        print command ": " FNR " paths that the preset " preset " found belong to its packages"
    }' "$work/allowed" "$work/owners" "$work/found"
