#include "datasets/letter.h"

#include "datasets/glyph.h"
#include "datasets/polygonise.h"
#include "datasets/remesh.h"

/* Squares of the sines of 10 degrees, the smallest angle that is guaranteed, and of 25 degrees,
   the smallest that is aimed at. */
#define PROMISED_QUALITY 0.030153689607045831
#define WANTED_QUALITY 0.17860619515673032

/* Starting with more triangles than asked for leaves short edges to collapse. */
#define SPARE 1.5
#define SWEEPS 6
#define EXTRA_SWEEPS 60

static mote_status relax(const mote_glyph *glyph, mote_surface *surface)
{
    for (int sweep = 0; sweep < SWEEPS; sweep++) {
        mote_relax_flip(surface);
        mote_relax_smooth(glyph, surface);
    }
    for (int sweep = 0; sweep < EXTRA_SWEEPS; sweep++)
        if (mote_relax_worst(glyph, WANTED_QUALITY, surface) == 0)
            break;
    mote_vec3 gradient;
    for (size_t v = 0; v < surface->vertex_slots; v++)
        surface->positions[v] = mote_glyph_project(glyph, surface->positions[v], 3, &gradient);
    if (mote_relax_worst(glyph, PROMISED_QUALITY, surface) > 0)
        return mote_fail(MOTE_ENUMERIC, "letter: %zu triangles have an angle below 10 degrees",
                         surface->live_triangles);
    return MOTE_OK;
}

/* A grid too coarse for a glyph would join its strokes or tear them. */
static mote_status check_euler(const mote_glyph *glyph, const mote_surface *surface)
{
    const int64_t euler =
        (int64_t)surface->vertex_slots - (int64_t)(surface->triangle_slots / 2);
    const int64_t wanted = 2 - 2 * (int64_t)glyph->holes;
    if (euler == wanted)
        return MOTE_OK;
    return mote_fail(MOTE_ENUMERIC, "letter: Euler characteristic %lld where it should be %lld",
                     (long long)euler, (long long)wanted);
}

static mote_status check_arguments(size_t triangle_count)
{
    if (triangle_count < MOTE_LETTER_MIN_TRIANGLES ||
        triangle_count > MOTE_LETTER_MAX_TRIANGLES)
        return mote_fail(
            MOTE_EINVAL,
            "letter: %zu triangles is out of range; use an even number from %d to %d",
            triangle_count, MOTE_LETTER_MIN_TRIANGLES, MOTE_LETTER_MAX_TRIANGLES);
    if (triangle_count % 2 != 0)
        return mote_fail(
            MOTE_EINVAL,
            "letter: %zu triangles is odd, and a closed surface has an even number; "
            "use %zu or %zu",
            triangle_count, triangle_count - 1, triangle_count + 1);
    return MOTE_OK;
}

mote_status mote_letter_create(char letter, size_t triangle_count, mote_mesh **mesh)
{
    mote_glyph glyph;
    mote_surface surface = {0};
    mote_status status = mote_glyph_make(letter, &glyph);
    if (status == MOTE_OK)
        status = check_arguments(triangle_count);
    if (status != MOTE_OK)
        return status;
    status = mote_polygonise(&glyph, (size_t)(SPARE * (double)triangle_count), &surface);
    if (status != MOTE_OK)
        return status;
    status = mote_simplify(&glyph, triangle_count, &surface);
    if (status == MOTE_OK)
        status = check_euler(&glyph, &surface);
    if (status == MOTE_OK)
        status = relax(&glyph, &surface);
    if (status == MOTE_OK)
        status = mote_mesh_create(&surface.positions[0].x, surface.vertex_slots, surface.vertex,
                                  surface.triangle_slots, mesh);
    mote_surface_clear(&surface);
    return status;
}
