# bash completion of mote: what it offers comes from the program itself.
_mote()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local program=${COMP_WORDS[0]} at=1 command table words= value
    COMPREPLY=()
    # The command comes after the options that every command has.
    while [ "$at" -lt "$COMP_CWORD" ]; do
        case ${COMP_WORDS[at]} in
        --strict) at=$((at + 1)) ;;
        --allow | --plugin) at=$((at + 2)) ;;
        *) break ;;
        esac
    done
    command=${COMP_WORDS[at]}
    # "command", name, arguments, summary; then "option", name, value, help; tabs between them.
    table=$("$program" --help-table 2>/dev/null)
    if [[ $previous = --allow || $previous = --plugin ]]; then
        compopt -o default
        return
    fi
    if [ "$COMP_CWORD" -eq "$at" ] || { [ "$COMP_CWORD" -eq 2 ] && [ "$command" = help ]; }; then
        words=$(printf '%s\n' "$table" | awk -F '\t' '$1 == "command" { print $2 }')
        [ "$command" = help ] || words="$words help --help --version --allow --plugin --strict"
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
        return
    fi
    table=$(printf '%s\n' "$table" |
        awk -F '\t' -v name="$command" '$1 == "command" { own = $2 == name } own')
    value=$(printf '%s\n' "$table" |
        awk -F '\t' -v name="$previous" '$1 == "option" && $2 == name { print $3 }')
    case $value in
    NAME\[*)
        words=$("$program" list methods 2>/dev/null | sed -n 's/^\([a-z][a-z0-9-]*\):.*/\1/p')
        compopt -o nospace
        ;;
    *'|'*) words=${value//|/ } ;;
    DIR | FILE* | *.obj*)
        compopt -o default
        return
        ;;
    esac
    if [ -z "$words" ]; then
        words="$(printf '%s\n' "$table" | awk -F '\t' '$1 == "option" { print $2 }') --help --plugin"
        case $table in
        *SCENARIO*)
            words="$words $("$program" list scenarios 2>/dev/null | cut -d ' ' -f 1)"
            ;;
        *'methods|scenarios|fields'*) words="$words methods scenarios fields" ;;
        esac
        compopt -o default
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -F _mote mote
