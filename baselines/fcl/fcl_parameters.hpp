/* The parameters that all FCL methods share, and their parsed form. */
#ifndef MOTE_BASELINES_FCL_PARAMETERS_HPP
#define MOTE_BASELINES_FCL_PARAMETERS_HPP

#include "core/body/sample_split.h"
#include "core/method/method.h"

namespace mote_fcl
{

/* In the order of the tables at the end. */
enum ParameterIndex { UPDATE, QUEUE, SEED, CALL, POSITIONS, BUILD, PARAMETER_COUNT };

enum UpdateMode { REFIT_BOTTOM_UP, REFIT_TOP_DOWN, REBUILD, NO_UPDATE };

struct Options {
    UpdateMode update;
    int queue;    /* 2: depth first; more: entries of FCL's priority queue */
    bool seeded;  /* start from the last query's triangle pair */
    bool api;     /* fcl::distance and fcl::collide instead of their traversal nodes */
    bool given;   /* deforming the vertices is not charged */
    bool samples; /* the tree is split by sample poses too */
};

inline Options read_options(const double *values)
{
    Options options = {};
    options.update = static_cast<UpdateMode>(static_cast<int>(values[UPDATE]));
    options.queue = values[QUEUE] == 0 ? 2 : 64;
    options.seeded = values[SEED] == 1;
    options.api = values[CALL] == 1;
    options.given = values[POSITIONS] == 1;
    options.samples = values[BUILD] == 1;
    return options;
}

constexpr mote_parameter choice(const char *key, const char *choices, const char *fallback,
                                const char *help)
{
    return mote_parameter{key, MOTE_PARAMETER_CHOICE, 0, 0, choices, fallback, help};
}

constexpr mote_parameter update_parameter(const char *fallback)
{
    return choice("update", "refit-bottom-up|refit-top-down|rebuild|none", fallback,
                  "how a tree follows a changed shape; none: rigid bodies, by transforms");
}

constexpr mote_parameter queue_parameter =
    choice("queue", "2|64", "2", "distance traversal: 2 depth first, 64 by priority queue");
constexpr mote_parameter seed_parameter =
    choice("seed", "none|previous", "none",
           "distance traversal: upper bound from the last query's triangle pair");
constexpr mote_parameter call_parameter =
    choice("call", "node|api", "node", "drive FCL's traversal node, or its public functions");
constexpr mote_parameter positions_parameter =
    choice("positions", "deform|given", "deform",
           "deform: pay for deforming all vertices; given: they come free of charge");
constexpr mote_parameter build_parameter =
    choice("build", MOTE_BUILD_CHOICES, "rest", MOTE_BUILD_HELP);

/* By how a tree is refitted where nothing else is asked. */
inline constexpr mote_parameter bottom_up_parameters[PARAMETER_COUNT] = {
    update_parameter("refit-bottom-up"),
    queue_parameter,
    seed_parameter,
    call_parameter,
    positions_parameter,
    build_parameter};
inline constexpr mote_parameter top_down_parameters[PARAMETER_COUNT] = {
    update_parameter("refit-top-down"),
    queue_parameter,
    seed_parameter,
    call_parameter,
    positions_parameter,
    build_parameter};

} // namespace mote_fcl

#endif
