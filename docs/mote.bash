# bash completion of mote: what it offers comes from the program itself.
_mote()
{
    local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
    local program=${COMP_WORDS[0]} command=${COMP_WORDS[1]} words
    COMPREPLY=()
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="$("$program" --help 2>/dev/null | sed -n 's/^  mote \([a-z]*\).*/\1/p') --help --version"
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
        return
    fi
    # "--cache hot|evict" in the usage: the values of an option.
    local usage
    usage=$("$program" "$command" --help 2>/dev/null)
    case $previous in
    --method)
        words=$("$program" list methods 2>/dev/null | sed -n 's/^\([a-z][a-z0-9-]*\):.*/\1/p')
        compopt -o nospace
        ;;
    --out | --pair | -o | --trace | --add)
        compopt -o default
        return
        ;;
    --*)
        words=$(printf '%s\n' "$usage" |
            sed -n "s/.*$previous \([a-z]*|[a-z|]*\).*/\1/p" | tr '|' ' ')
        ;;
    *) words= ;;
    esac
    if [ -z "$words" ]; then
        words=$(printf '%s\n' "$usage" | grep -oE -- '--[a-z-]+')
        case $usage in
        *SCENARIO*)
            words="$words $("$program" list scenarios 2>/dev/null | cut -d ' ' -f 1)"
            ;;
        *'list methods'*) words="$words methods scenarios fields" ;;
        esac
        compopt -o default
    fi
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$current")
}
complete -F _mote mote
