/* coal-aabb, coal-obb, coal-rss, coal-obbrss, coal-kios: Coal, once a branch of FCL, with its
   traversal of the same kinds of trees. Built only where CMake finds Coal, of which Debian has
   no package (docs/peers.md says how it is built).

   bound=coal is Coal as released. bound=full mends one bound: the distance of two axis-aligned
   boxes is taken from all three axes. AABB and RSS are refitted bottom-up; the others top-down,
   since Coal's sum of oriented boxes leaves triangles outside (datasets/defects.md). */
#include "baselines/coal_pair.hpp"
#include "baselines/guard.hpp"

namespace
{

using namespace mote_coal;

enum ParameterIndex { UPDATE, QUEUE, SEED, CALL, BOUND, CONTACT, POSITIONS, PARAMETER_COUNT };

constexpr mote_parameter choice(const char *key, const char *choices, const char *fallback,
                                const char *help)
{
    return mote_parameter{key, MOTE_PARAMETER_CHOICE, 0, 0, choices, fallback, help};
}

#define UPDATE_PARAMETER(fallback)                                                             \
    choice("update", "refit-bottom-up|refit-top-down|rebuild|none", fallback,                  \
           "how a tree follows a changed shape; none: rigid bodies, by transforms")
#define MORE_PARAMETERS                                                                        \
    choice("queue", "2|64", "2", "distance traversal: 2 depth first, 64 by priority queue"),   \
        choice("seed", "none|previous", "none",                                                \
               "distance traversal: upper bound from the last query's triangle pair"),         \
        choice("call", "node|api", "node",                                                     \
               "drive Coal's traversal node, or its public functions"),                        \
        choice("bound", "coal|full", "coal",                                                   \
               "distance of two axis-aligned boxes: as released, or by all three axes"),       \
        choice("contact", "collide|distance", "collide",                                       \
               "contact by the collision traversal, or by a distance that stops"),             \
        choice("positions", "deform|given", "deform",                                          \
               "deform: pay for deforming all vertices; given: they come free of charge")

constexpr mote_parameter bottom_up[PARAMETER_COUNT] = {UPDATE_PARAMETER("refit-bottom-up"),
                                                       MORE_PARAMETERS};
constexpr mote_parameter top_down[PARAMETER_COUNT] = {UPDATE_PARAMETER("refit-top-down"),
                                                      MORE_PARAMETERS};

Options read_options(const double *values)
{
    Options options = {};
    options.update = static_cast<UpdateMode>(static_cast<int>(values[UPDATE]));
    options.queued = values[QUEUE] > 0;
    options.seeded = values[SEED] > 0;
    options.api = values[CALL] > 0;
    options.full = values[BOUND] > 0;
    options.collides = values[CONTACT] <= 0;
    options.given = values[POSITIONS] > 0;
    return options;
}

template <class Body> mote_status guard(Body &&body) noexcept
{
    return mote_guard("Coal", body);
}

template <class BV> struct Adapter {
    static mote_traits traits(const double *values)
    {
        const Options options = read_options(values);
        mote_traits traits = {};
        const bool vertices = options.update != NO_UPDATE;
        traits.needs_vertices = vertices && !options.given;
        traits.given_vertices = vertices && options.given;
        traits.keeps_state = options.seeded;
        return traits;
    }

    static mote_status supported(const mote_setup *setup, const Options &options)
    {
        const bool distance =
            setup->ask == MOTE_ASK_DISTANCE || setup->tolerance > 0 || !options.collides;
        if (distance && !Kind<BV>::has_distance)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "Coal has no distance of oriented boxes; only contact=collide at "
                             "tolerance 0");
        if (options.full && (Kind<BV>::oriented || options.api))
            return mote_fail(MOTE_EUNSUPPORTED,
                             "bound=full is for coal-aabb by its node; bound=coal");
        if (options.api && options.queued)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "Coal's public functions have no queue; queue=2 or call=node");
        if (options.update != NO_UPDATE)
            return MOTE_OK;
        if (!Kind<BV>::oriented)
            return mote_fail(MOTE_EUNSUPPORTED,
                             "update=none needs a volume that Coal transforms in place");
        for (int b = 0; b < 2; ++b) {
            if (!mote_body_is_rigid(setup->body[b]))
                return mote_fail(MOTE_EUNSUPPORTED,
                                 "update=none needs rigid bodies; body %d deforms", b);
        }
        return MOTE_OK;
    }

    static mote_status create(const mote_setup *setup, void **state)
    {
        const Options options = read_options(setup->values);
        mote_status status = supported(setup, options);
        if (status == MOTE_OK)
            status = mote_input_check(setup);
        if (status != MOTE_OK)
            return status;
        return guard([&] {
            *state = new Pair<BV>(setup, options);
            return MOTE_OK;
        });
    }

    static void destroy(void *state)
    {
        delete static_cast<Pair<BV> *>(state);
    }

    static mote_status update(void *state, const mote_frame *frame)
    {
        return guard([&] { return static_cast<Pair<BV> *>(state)->update(frame); });
    }

    static mote_status query(void *state, const mote_frame *, mote_answer *answer)
    {
        return guard([&] { return static_cast<Pair<BV> *>(state)->query(answer); });
    }
};

template <class BV>
constexpr mote_method describe(const char *name, const char *summary,
                               const mote_parameter (&parameters)[PARAMETER_COUNT])
{
    using A = Adapter<BV>;
    return mote_method{name,      summary,    parameters, PARAMETER_COUNT, A::traits,
                       A::create, A::destroy, A::update,  A::query,        nullptr};
}

} // namespace

MOTE_METHOD(coal_aabb) = describe<coal::AABB>("coal-aabb",
                                              "Coal: axis-aligned boxes, refit bottom-up",
                                              bottom_up);
MOTE_METHOD(coal_obb) = describe<coal::OBB>(
    "coal-obb", "Coal: oriented boxes, refit top-down; contact only", top_down);
MOTE_METHOD(coal_rss) = describe<coal::RSS>("coal-rss",
                                            "Coal: rectangle swept spheres, refit bottom-up",
                                            bottom_up);
MOTE_METHOD(coal_obbrss) = describe<coal::OBBRSS>(
    "coal-obbrss", "Coal: oriented boxes and swept spheres, refit top-down", top_down);
MOTE_METHOD(coal_kios) = describe<coal::kIOS>(
    "coal-kios", "Coal: oriented boxes and spheres, refit top-down", top_down);
