# The third-party engines in this build, each with its authors' settings and with the best settings that
# we know of. Sourced after measure.sh by bench.sh and tune.sh; needs $mote.
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

# measure_distances SCENARIO ARGUMENT...: engines that answer distances.
measure_distances() {
    measure "$@" --method 'fcl-aabb:seed=previous,queue=2|64,build=rest|samples'
    measure_engine coal-aabb ':bound=coal|full,seed=previous' "$@"
    measure_engine coal-aabb ':bound=full,seed=previous,queue=64' "$@"
}

# measure_contacts SCENARIO ARGUMENT...: engines that answer contacts.
measure_contacts() {
    measure "$@" --method 'fcl-aabb:build=rest|samples'
    measure_engine coal-aabb '' "$@"
    measure_engine coal-aabb ':contact=distance,bound=full,seed=previous' "$@"
    measure_engine ode ':vertices=double|single' "$@"
    measure_engine bullet-gimpact ':stop=no|yes' "$@"
    measure_engine embree-contact '' "$@"
}

# measure_rigid SCENARIO ARGUMENT...: engines that move rigid bodies by their poses; if contacts are
# asked, also those that answer only contacts.
measure_rigid() {
    for volume in obb rss obbrss kios; do
        measure "$@" --method "fcl-$volume:update=none,build=rest|samples"
        case "$1 $volume" in
        *-distance\ obb) ;;
        *) measure_engine coal-$volume ':update=none' "$@" ;;
        esac
    done
    case $1 in
    *-distance) ;;
    *)
        measure_engine ode ':update=none,vertices=double|single' "$@"
        measure_engine bullet-gimpact ':update=none,stop=no|yes' "$@"
        ;;
    esac
}
