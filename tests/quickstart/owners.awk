# Reads dpkg-query's list of installed packages, one a line: name, priority, essential, provides, pre-depends, depends, in
# columns parted by tabs. Prints those that a bare Debian with the packages of `wanted` has.

function bare(name) {
    sub(/[ (:[].*/, "", name)
    return name
}

function want(name) {
    if (name in installed && !(name in taken)) {
        taken[name] = 1
        queue[++last] = name
    }
}

# The first alternative that is installed is the one that is used; of a name that packages only provide, each provider.
function follow(dependency, alternatives, n, i, name, providers, m, j) {
    n = split(dependency, alternatives, /[ ]*\|[ ]*/)
    for (i = 1; i <= n; ++i) {
        name = bare(alternatives[i])
        if (name in installed) {
            want(name)
            return
        }
        if (name in provided_by) {
            m = split(provided_by[name], providers, " ")
            for (j = 1; j <= m; ++j) {
                want(providers[j])
            }
            return
        }
    }
}

BEGIN { FS = "\t" }

{
    installed[$1] = $5 ", " $6
    if ($2 == "required" || $3 == "yes" || $1 == "apt") {
        base[$1] = 1
    }
    n = split($4, names, /,[ ]*/)
    for (i = 1; i <= n; ++i) {
        name = bare(names[i])
        if (name != "") {
            provided_by[name] = provided_by[name] " " $1
        }
    }
}

END {
    for (name in base) {
        want(name)
    }
    n = split(wanted, names, " ")
    for (i = 1; i <= n; ++i) {
        want(names[i])
    }
    for (next_one = 1; next_one <= last; ++next_one) {
        m = split(installed[queue[next_one]], dependencies, /,[ ]*/)
        for (i = 1; i <= m; ++i) {
            follow(dependencies[i])
        }
    }
    for (name in taken) {
        print name
    }
}
