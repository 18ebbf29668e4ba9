# verdicts.awk: of a run's summary.csv, the contacts that each configuration missed and invented over all
# scenarios, those of ours first. Exits with 1 if a method named in `ours` is wrong anywhere, or answered nothing.
BEGIN {
    count = split(ours, names, " ")
    for (i = 1; i <= count; ++i) own[names[i]] = 1
}

NR == 1 {
    count = split($0, heads, ",")
    for (i = 1; i <= count; ++i) column[heads[i]] = i
    next
}

{
    # "scenario",cache,method,"label",the rest: only the first and the fourth may hold commas.
    split($0, quoted, "\"")
    label = quoted[4]
    split(quoted[5], values, ",")
    shift = column["label"] - 1
    name = label
    sub(/:.*/, "", name)
    status = values[column["status"] - shift]
    if (status == "unsupported") next
    if (status != "ok") {
        failures = failures sprintf("%s on %s: %s\n", label, quoted[2], status)
        if (name in own) bad = 1
        next
    }
    if (!(label in frames)) order[++labels] = label
    frames[label] += values[column["frames"] - shift]
    contacts[label] += values[column["contacts"] - shift]
    missed = values[column["missed"] - shift]
    invented = values[column["false_contacts"] - shift]
    all_missed[label] += missed
    all_invented[label] += invented
    ++scenarios[label]
    if (missed + invented > 0) {
        if (name in own) bad = 1
        wrong = wrong sprintf("%s on %s: missed %d of %d contacts, invented %d in %d frames\n", label, quoted[2],
            missed, values[column["contacts"] - shift], invented, values[column["frames"] - shift])
    }
}

function show(label) {
    printf "%-52s %9d %8d %8d %7d %7d\n", label, scenarios[label], frames[label], contacts[label],
        all_missed[label], all_invented[label]
}

END {
    printf "%-52s %9s %8s %8s %7s %7s\n", "method", "scenarios", "frames", "contacts", "missed", "false"
    for (round = 0; round < 2; ++round)
        for (i = 1; i <= labels; ++i) {
            name = order[i]
            sub(/:.*/, "", name)
            if ((name in own) == !round) show(order[i])
        }
    if (wrong) printf "\nwrong:\n%s", wrong
    if (failures) printf "\nwithout an answer:\n%s", failures
    for (name in own) if (!(name in scenarios)) bad = 1
    exit bad
}
