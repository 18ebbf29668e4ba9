# least.awk CELL.json CELL.csv ...: of a run's cells, a line for each scenario and configuration, fields apart by tabs:
# scenario, method, parameters, frames, median and sum over frames of the total time in ns. Of each frame the least
# time of all replicates counts, so that what else the machine did in one of them does not. The sum is from frame 50
# on, where there are 60 frames or more: before, a method may still build what it needs.
FILENAME ~ /[.]json$/ {
    if (FNR == 1) scenario = method = parameters = status = ""
    text = $0
    gsub(/[" ,]/, "", text)
    if (text == "parameters:{") inside = 1
    else if (text == "}") inside = 0
    else if (inside) parameters = parameters (parameters == "" ? "" : ",") text
    else if (text ~ /^scenario:/) scenario = substr(text, 10)
    else if (text ~ /^method:/) method = substr(text, 8)
    else if (text ~ /^status:/) status = substr(text, 8)
    next
}

FNR == 1 {
    for (i = split($0, heads, ","); i > 0; --i) column[heads[i]] = i
    key = scenario "\t" method "\t" parameters
    rows = 0
    if (status == "ok" && !(key in frames)) order[++keys] = key
    next
}

status == "ok" {
    split($0, value, ",")
    ++rows
    time = value[column["deform_ns"]] + value[column["update_ns"]] + value[column["query_ns"]]
    if (!((key, rows) in least) || time < least[key, rows]) least[key, rows] = time
    if (rows > frames[key]) frames[key] = rows
}

# The median of sorted[1 .. count], which is put in order (shell sort).
function median(count, gap, i, k, x) {
    for (gap = int(count / 2); gap > 0; gap = int(gap / 2))
        for (i = gap + 1; i <= count; ++i) {
            x = sorted[i]
            for (k = i; k > gap && sorted[k - gap] > x; k -= gap) sorted[k] = sorted[k - gap]
            sorted[k] = x
        }
    return (sorted[int((count + 1) / 2)] + sorted[int((count + 2) / 2)]) / 2
}

END {
    for (k = 1; k <= keys; ++k) {
        key = order[k]
        sum = 0
        for (i = 1; i <= frames[key]; ++i) {
            sorted[i] = least[key, i]
            if (i >= 50 || frames[key] < 60) sum += sorted[i]
        }
        printf "%s\t%d\t%.0f\t%.0f\n", key, frames[key], median(frames[key]), sum
    }
}
