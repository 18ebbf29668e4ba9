# The third-party engines in this build, each with its authors' settings and with the best settings that
# we know of. Sourced after measure.sh by bench.sh, tune.sh and
# verdicts.sh; needs $mote and $out.
methods=$("$mote" list methods | sed -n 's/^\([a-z0-9-]*\):.*/\1/p')

# has METHOD: whether this build has it.
has() {
    case "
$methods
" in
    *"
$1
"*) ;;
    *) return 1 ;;
    esac
}

# measure_engine METHOD CONFIGURATION ARGUMENT...: measures a method if this build has it.
measure_engine() {
    if has "$1"; then
        engine=$1$2
        shift 2
        measure "$@" --method "$engine"
    fi
}

# offered METHOD CONFIGURATION: as an option, if this build has the method.
offered() {
    if has "$1"; then echo "--method $1$2"; fi
}

# The engines of others that answer distances, contacts, and those that move rigid bodies by their poses, if
# QUESTION is contact also those that answer only contacts. One `mote run` asks them in turn.
distance_engines() {
    offered fcl-aabb ':seed=previous,queue=2|64,build=rest|samples'
    offered coal-aabb ':bound=coal|full,seed=previous'
    offered coal-aabb ':bound=full,seed=previous,queue=64'
}

contact_engines() {
    offered fcl-aabb ':build=rest|samples'
    offered coal-aabb ''
    offered coal-aabb ':contact=distance,bound=full,seed=previous'
    offered ode ':vertices=double|single'
    offered bullet-gimpact ':stop=no|yes'
    offered embree-contact ''
}

rigid_engines() { # QUESTION
    for volume in obb rss obbrss kios; do
        offered fcl-$volume ':update=none,build=rest|samples'
        if [ "$1 $volume" != 'distance obb' ]; then offered coal-$volume ':update=none'; fi
    done
    if [ "$1" = contact ]; then
        offered ode ':update=none,vertices=double|single'
        offered bullet-gimpact ':update=none,stop=no|yes'
    fi
}

# ask_contact NAME: the path of a scenario with the frames of NAME that asks for contact only.
ask_contact() {
    mkdir -p "$out/scenarios"
    asked=$out/scenarios/$1.json
    built_in=$(find datasets/scenarios -name "$1.json")
    if grep -q '^  "like":' "$built_in"; then
        # A scenario like another one cannot be named by "like".
        sed 's/^  "like": "[^"]*",$/&\n  "ask": "contact",/' "$built_in" >"$asked"
    else
        printf '{"purpose": "Contacts of %s.", "like": "%s", "ask": "contact"}\n' "$1" "$1" >"$asked"
    fi
    echo "$asked"
}
