# peers.awk: from a run's summary.csv, the tables of docs/peers.md: contact and distance, a table a scenario, in
# microseconds a frame. Of each method it has the row with its defaults and those that are best by the median and by
# the mean. A star marks, in each column, the engine of others that is best without a wrong answer.
BEGIN {
    statistics = split("total_ns_median total_ns_mean total_ns_p95 total_ns_max", statistic, " ")
    contacts = split("ww-contact mv-contact tt rigid-ww rigid-mv", contact, " ")
    distances = split("ww mv tt-distance", distance, " ")
    own["certified"] = own["aabb-tree"] = 1
}

NR == 1 {
    count = split($0, heads, ",")
    for (i = 1; i <= count; ++i) column[heads[i]] = i
    next
}

{
    # "scenario",cache,method,"label",the rest: only the first and the fourth may hold commas.
    split($0, quoted, "\"")
    scenario = quoted[2]
    label = quoted[4]
    split(quoted[5], values, ",")
    shift = column["label"] - 1
    status = values[column["status"] - shift]
    if (status == "unsupported") next
    row = ++rows[scenario]
    labels[scenario, row] = label
    states[scenario, row] = status
    methods[scenario, row] = label
    sub(/:.*/, "", methods[scenario, row])
    for (s = 1; s <= statistics; ++s) times[scenario, row, s] = values[column[statistic[s]] - shift] / 1000
    wrongs[scenario, row] = values[column["missed"] - shift] + values[column["false_contacts"] - shift]
    frames[scenario] = values[column["frames"] - shift]
    replicates[scenario] = values[column["replicates"] - shift]
}

# Three digits and more, thousands set apart.
function shown(value) {
    if (value < 1) return sprintf("%.3f", value)
    if (value < 10) return sprintf("%.2f", value)
    if (value < 100) return sprintf("%.1f", value)
    if (value < 1000) return sprintf("%.0f", value)
    return sprintf("%d,%03d", int((value + 0.5) / 1000), int(value + 0.5) % 1000)
}

# The best row by a statistic, of one method, or of all engines of others without a wrong answer (method "").
function best(scenario, method, s,    row, found) {
    for (row = 1; row <= rows[scenario]; ++row) {
        if (states[scenario, row] != "ok") continue
        if (method != "" && methods[scenario, row] != method) continue
        if (method == "" && (methods[scenario, row] in own || wrongs[scenario, row] > 0)) continue
        if (!found || times[scenario, row, s] < times[scenario, found, s]) found = row
    }
    return found
}

function table(scenario,    row, next_row, s, i, line, order, kept) {
    if (!rows[scenario]) return
    printf "\n### `%s`\n\n%d frames, %d process%s a row.\n\n", scenario, frames[scenario], replicates[scenario],
        (replicates[scenario] > 1 ? "es" : "")
    print "| | median | mean | p95 | worst | wrong |"
    print "| --- | ---: | ---: | ---: | ---: | ---: |"
    for (row = 1; row <= rows[scenario]; ++row)
        if (states[scenario, row] != "ok" || labels[scenario, row] == methods[scenario, row] ||
            row == best(scenario, methods[scenario, row], 1) || row == best(scenario, methods[scenario, row], 2))
            order[++kept] = row
    for (row = 2; row <= kept; ++row)
        for (i = row; i > 1 && times[scenario, order[i], 1] < times[scenario, order[i - 1], 1]; --i) {
            next_row = order[i]
            order[i] = order[i - 1]
            order[i - 1] = next_row
        }
    for (i = 1; i <= kept; ++i) {
        row = order[i]
        if (states[scenario, row] != "ok") {
            printf "| `%s` | %s | | | | |\n", labels[scenario, row], states[scenario, row]
            continue
        }
        line = sprintf("| `%s` |", labels[scenario, row])
        for (s = 1; s <= statistics; ++s)
            line = line sprintf(" %s%s |", shown(times[scenario, row, s]), row == best(scenario, "", s) ? " *" : "")
        print line sprintf(" %d |", wrongs[scenario, row])
    }
}

END {
    print "## Contact"
    for (k = 1; k <= contacts; ++k) table(contact[k])
    print "\n## Distance"
    for (k = 1; k <= distances; ++k) table(distance[k])
}
