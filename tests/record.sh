#!/usr/bin/env bash
# Keeps what was tried as committed evidence, and writes the table of README.md again.
#   record.sh CHECKS.tsv [COMMIT [DATE]]      lines of {check, tried, failed}, as make reliability
#                                             leaves them; COMMIT and DATE: of what was tested
#   record.sh --fuzz FUZZ.tsv [COMMIT [DATE]] lines of fuzz.sh, added to tests/corpus/log.csv
# results/reference/reliability.csv holds the last line of every check.
set -eu
fuzz=
if [ "$1" = --fuzz ]; then
    fuzz=1
    shift
fi
here=$(git rev-parse --short HEAD)
if [ -n "$(git status --porcelain -- core harness baselines datasets cmake CMakeLists.txt)" ]; then
    here=$here+
fi
commit=${2:-$here}
date=${3:-$(date -u +%Y-%m-%d)}
csv=results/reference/reliability.csv log=tests/corpus/log.csv
[ -f $log ] || echo "date,commit,target,cpu_seconds,executions,findings" >$log
[ -f $csv ] || echo "check,tried,failed,date,commit" >$csv
if [ -n "$fuzz" ]; then
    awk -F'\t' -v d="$date" -v c="$commit" \
        '{ printf "%s,%s,%s,%d,%d,%d\n", d, c, $1, $2, $3, $4 }' "$1" >>$log
else
    # Fuzzing adds up in its own log.
    grep -v '^fuzz: ' "$1" | awk -F'\t' -v d="$date" -v c="$commit" -v csv=$csv '
        BEGIN { OFS = "," }
        { new = "\"" $1 "\"," $2 "," $3 "," d "," c; name = "\"" $1 "\""; fresh[name] = new
          order[++n] = name }
        END {
            while ((getline line < csv) > 0) {
                name = line; sub(/",.*/, "\"", name)
                if (name in fresh) { print fresh[name]; done[name] = 1 } else print line
            }
            for (i = 1; i <= n; ++i)
                if (!(order[i] in done)) { print fresh[order[i]]; done[order[i]] = 1 }
        }' >$csv.part
    mv $csv.part $csv
fi

table() {
    echo "| check | tried | failed | date, commit |"
    echo "| --- | ---: | ---: | --- |"
    sed 1d $csv | sed -E 's/^"([^"]*)",([0-9]*),([0-9]*),([^,]*),(.*)$/| \1 | \2 | \3 | \4, \5 |/'
    sed 1d $log | awk -F, '
        { s[$3] += $4; e[$3] += $5; f[$3] += $6; last[$3] = $1 ", " $2 }
        END {
            split("scenario mesh options cell", t, " ")
            for (i = 1; i <= 4; ++i)
                if (e[t[i]])
                    printf "| fuzz: %s, %.2f CPU hours in all | %d | %d | %s |\n", t[i],
                        s[t[i]] / 3600, e[t[i]], f[t[i]], last[t[i]]
        }'
}
table >README.table
awk '/^<!-- reliability -->$/ {
        print; print ""
        while ((getline line < "README.table") > 0) print line
        print ""; skip = 1
    }
    /^<!-- end of reliability -->$/ { skip = 0 }
    !skip' README.md >README.new
rm README.table
mv README.new README.md
