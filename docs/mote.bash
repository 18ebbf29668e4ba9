# bash completion of mote: what it offers comes from the program itself.
_mote()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} table words= value
    COMPREPLY=()
    # "command", name, arguments, summary; then "option", name, value, help; tabs between them.
    table=$("$program" --help-table 2>/dev/null)
    if [ "$COMP_CWORD" -eq 1 ] || { [ "$COMP_CWORD" -eq 2 ] && [ "$command" = help ]; }; then
        words=$(printf '%s\n' "$table" | awk -F '\t' '$1 == "command" { print $2 }')
        [ "$COMP_CWORD" -eq 2 ] || words="$words help --help --version"
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
        words="$(printf '%s\n' "$table" | awk -F '\t' '$1 == "option" { print $2 }') --help"
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
