/* A scenario's frames as pictures: deformed bodies seen from a camera, as data for gnuplot. */
#ifndef MOTE_HARNESS_FIGURE_SCENE_H
#define MOTE_HARNESS_FIGURE_SCENE_H

#include "harness/figure/figure.h"
#include "harness/scene/scenario.h"

typedef struct mote_figure_scene {
    mote_scenario *scenario;
    mote_frame_buffer *buffer;
    struct mote_deform *deform[2];
    mote_vec3 *world[2];     /* vertices of the current frame */
    const mote_frame *frame; /* the current frame */
} mote_figure_scene;

/* Loads the scenario that a row was measured on, by its name. MOTE_EINVAL if its frames are not
   the measured ones. Close even after a failure. */
mote_status mote_figure_scene_open(const mote_summary_row *row, mote_figure_scene *scene);
void mote_figure_scene_close(mote_figure_scene *scene);

/* Deforms both bodies for frame 1 .. scenario->frames. */
void mote_figure_scene_show(mote_figure_scene *scene, uint32_t frame);

/* Axes of the picture in the world, orthonormal; toward points at the viewer. The picture's
   coordinates are (p - centre) * scale along them. */
typedef struct mote_figure_camera {
    mote_vec3 right, up, toward, centre;
    double scale;
} mote_figure_camera;

/* Aims perpendicular to the line between the bodies' middles, from the direction that shows
   most of the points (count may be 0) and of the surfaces. scale 1, centre 0. */
mote_figure_camera mote_figure_camera_aim(const mote_figure_scene *scene,
                                          const mote_vec3 *points, size_t count);

/* A rectangle of the picture: low and high x, y. */
typedef struct mote_figure_box {
    double low[2], high[2];
} mote_figure_box;

/* Extends box by the current frame. */
void mote_figure_box_add(const mote_figure_scene *scene, const mote_figure_camera *camera,
                         mote_figure_box *box);

/* Moves and scales the camera so that the box fills a picture of width 2 and height 2 *
   aspect. */
void mote_figure_camera_fit(mote_figure_camera *camera, const mote_figure_box *box,
                            double aspect);

mote_vec3 mote_figure_see(const mote_figure_camera *camera, mote_vec3 point);

/* Whether a surface of the current frame is in front of the point by more than 0.5 % of L. */
bool mote_figure_hidden(const mote_figure_scene *scene, const mote_figure_camera *camera,
                        mote_vec3 point);

/* Adds a block of the front-facing triangles of body i as closed outlines, a blank line after
   each. */
void mote_figure_add_body(const mote_figure_scene *scene, const mote_figure_camera *camera,
                          int i, mote_text *text);

/* Adds a block of the control vectors of body i: each control point at rest, x y z, and its
   displacement times MOTE_FIGURE_LONGER, dx dy dz. */
#define MOTE_FIGURE_LONGER 3
void mote_figure_add_controls(const mote_figure_scene *scene, const mote_figure_camera *camera,
                              int i, mote_text *text);

#endif
