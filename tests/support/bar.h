/* A character as a text in the format X: a square bar along x from 0 to 2 of three rings, 20
   triangles. Bone Upper, at x = 1, moves the last ring wholly and the middle one by half; in
   one second it turns by 90 degrees about z. */
#ifndef MOTE_TESTS_BAR_H
#define MOTE_TESTS_BAR_H

#include "tests/support/folder.h"

#define BAR_VERTICES 12
#define BAR_TRIANGLES 20
#define BAR_RINGS 3

/* Parts of the text, which tests replace by invalid ones. assimp reads "1,0" as one number with
   a decimal comma, so all numbers have a decimal point. */
typedef struct bar_text {
    const char *upper_weights; /* of vertices 4 to 11 for Upper */
    const char *rotations;     /* keys: time;4;w,x,y,z;; */
    const char *rotation_count;
    const char *upper;   /* the name of the bone's node */
    const char *bind;    /* the fourth row of Upper's offset matrix */
    const char *clip[2]; /* names */
} bar_text;

static inline bar_text bar_default(void)
{
    return (bar_text){"0.5,0.5,0.5,0.5,1.0,1.0,1.0,1.0",
                      "0;4;1.0,0.0,0.0,0.0;;,10;4;0.70710678,0.0,0.0,-0.70710678;;;",
                      "2",
                      "Upper",
                      "-1.0,0.0,0.0,1.0",
                      {"Bend", "Still"}};
}

static inline void bar_write(const char *path, bar_text part)
{
    static const double ring[4][2] = {
        {-0.25, -0.25}, {0.25, -0.25}, {0.25, 0.25}, {-0.25, 0.25}};
    static const char *const identity = "1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,";
    FILE *f = fopen(path, "w");
    if (!f)
        abort();
    fprintf(f, "xof 0303txt 0032\nAnimTicksPerSecond { 10; }\n");
    fprintf(f, "Frame Root {\n FrameTransformMatrix { %s0.0,0.0,0.0,1.0;; }\n", identity);
    fprintf(f, " Frame Lower {\n  FrameTransformMatrix { %s0.0,0.0,0.0,1.0;; }\n", identity);
    fprintf(f, "  Frame %s {\n   FrameTransformMatrix { %s1.0,0.0,0.0,1.0;; }\n  }\n }\n",
            part.upper, identity);
    fprintf(f, " Mesh Bar {\n  12;\n");
    for (int v = 0; v < BAR_VERTICES; ++v)
        fprintf(f, "  %d;%g;%g;%s\n", v / 4, ring[v % 4][0], ring[v % 4][1],
                v + 1 < BAR_VERTICES ? "," : ";");
    fprintf(f, "  20;\n");
    for (int s = 0; s < 8; ++s) {
        const int a = s / 4 * 4 + s % 4, b = s / 4 * 4 + (s + 1) % 4;
        fprintf(f, "  3;%d,%d,%d;,\n  3;%d,%d,%d;,\n", a, b, b + 4, a, b + 4, a + 4);
    }
    fprintf(f, "  3;0,2,1;,\n  3;0,3,2;,\n  3;8,9,10;,\n  3;8,10,11;;\n");
    fprintf(f, "  XSkinMeshHeader { 2; 2; 2; }\n");
    fprintf(f,
            "  SkinWeights { \"Lower\"; 8; 0,1,2,3,4,5,6,7; 1.0,1.0,1.0,1.0,0.5,0.5,0.5,0.5; "
            "%s0.0,0.0,0.0,1.0;; }\n",
            identity);
    fprintf(f, "  SkinWeights { \"Upper\"; 8; 4,5,6,7,8,9,10,11; %s; %s%s;; }\n }\n}\n",
            part.upper_weights, identity, part.bind);
    fprintf(f,
            "AnimationSet %s {\n Animation {\n  {%s}\n"
            "  AnimationKey { 0; %s; %s }\n"
            "  AnimationKey { 2; 1; 0;3;1.0,0.0,0.0;;; }\n }\n}\n",
            part.clip[0], part.upper, part.rotation_count, part.rotations);
    fprintf(f,
            "AnimationSet %s {\n Animation {\n  {Lower}\n"
            "  AnimationKey { 2; 1; 0;3;0.0,0.0,0.0;;; }\n }\n}\n",
            part.clip[1]);
    (void)fclose(f);
}

#endif
