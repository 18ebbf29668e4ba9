/* Commands on scenarios of an unusual form, while each place where they ask for memory, files
   or processes fails once. */
#include "tests/faults/fault_lines.h"
#include "tests/support/test.h"

#include <stddef.h>

/* A body with everything that a body can have, and one that moves along keys. */
#define RICH                                                                                   \
    "{\"purpose\": \"a test\", \"frames\": 4, \"ask\": \"distance\", \"tolerance\": 0.001, "   \
    "\"start\": 1.5, \"pace\": 0.5, \"warmup\": [1, 1], \"bodies\": [{\"file\": \"a.obj\", "   \
    "\"scale\": [1, 2, 1], \"velocity\": [0, 0.01, 0], \"spin\": [1, 0, 0], \"field\": "       \
    "{\"centres\": [[0, 0, 0], [0.2, 0.1, 0]], \"support\": 0.7, \"displacement\": "           \
    "{\"sines\": [{\"control\": 1, \"amplitude\": [0.1, 0, 0], \"period\": 30, \"phase\": "    \
    "0.25}, {\"control\": 2, \"amplitude\": [0, 0.1, 0], \"period\": 20}]}}}, {\"file\": "     \
    "\"a.obj\", \"field\": {\"kind\": \"csrbf\", \"count\": 2, \"support\": 0.7, "             \
    "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0], [0, 0, 0]]}, " \
    "{\"frame\": 4, \"vectors\": [[0.1, 0, 0], [0, 0.1, 0]]}]}}, \"motion\": [{\"frame\": 1, " \
    "\"position\": [2.1, 0.1, 0], \"quaternion\": [1, 0, 0, 0]}, {\"frame\": 4, "              \
    "\"position\": [1.9, 0.1, 0], \"axis\": [1, 0, 0], \"degrees\": 30}]}]}\n"
#define STRETCH                                                                                \
    "{\"purpose\": \"a test\", \"like\": \"s.json\", \"bodies\": [{\"field\": {\"count\": "    \
    "null, \"support\": null, \"kind\": \"stretch\"}}, {}]}\n"
#define KEYED                                                                                  \
    "{\"purpose\": \"a test\", \"frames\": 3, \"ask\": \"contact\", \"tolerance\": 0.01, "     \
    "\"bodies\": {\"count\": 3, \"box\": 4, \"places\": [[-1.5, 0, 0], [0, 0, 0], [1.5, 0, "   \
    "0]], \"shapes\": [{\"file\": \"a.obj\", \"field\": {\"count\": 2, \"support\": 0.7, "     \
    "\"displacement\": {\"keyframes\": [{\"frame\": 1, \"vectors\": [[0, 0, 0], [0, 0, 0]]}, " \
    "{\"frame\": 3, \"vectors\": [[0.1, 0, 0], [0, 0.1, 0]]}]}}}]}}\n"

/* An icosahedron. */
#define ROUND                                                                                  \
    "v 0 1 1.6\nv 0 -1 1.6\nv 0 1 -1.6\nv 0 -1 -1.6\nv 1 1.6 0\nv -1 1.6 0\nv 1 -1.6 0\n"      \
    "v -1 -1.6 0\nv 1.6 0 1\nv -1.6 0 1\nv 1.6 0 -1\nv -1.6 0 -1\n"                            \
    "f 1 2 9\nf 1 10 2\nf 3 11 4\nf 3 4 12\nf 1 9 5\nf 1 6 10\nf 1 5 6\nf 3 6 5\nf 3 5 11\n"   \
    "f 3 12 6\nf 2 7 9\nf 2 10 8\nf 2 8 7\nf 4 11 7\nf 4 7 8\nf 4 8 12\nf 5 9 11\nf 7 11 9\n"  \
    "f 6 12 10\nf 8 10 12\n"

TEST(scenarios_of_every_form_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(check, " rich.json", 0),
        LINE(export, " rich.json --frame 3 --out out --method fcl-kdop18", 0),
        LINE(export, " stretch.json --frame 2 --out out", 0),
        LINE(export, " pair:c.obj:c.obj --frame 2 --out out", 0),
        LINE(check, " nothing", 4),
    };
    FAIL_EACH(list);
}

TEST(several_bodies_when_a_call_fails_say_so)
{
    static const fault_line list[] = {
        LINE(run, " keyed.json --method certified:threads=2,ahead=2 --replicates 1 --out out",
             0),
        LINE(simulate, " b.json --method aabb-tree --json --steps 3 --gravity 0,0.001,0", 0),
        LINE(simulate, " b.json --method particle:n=2,threads=2 --steps 2", 0),
        LINE(simulate, " b.json --method certified --steps 2 --trace t.json", 0),
    };
    FAIL_EACH(list);
}

static int make_files(void)
{
    return fault_lines_open() && fault_lines_write("c.obj", ROUND) &&
                   fault_lines_write("rich.json", RICH) &&
                   fault_lines_write("stretch.json", STRETCH) &&
                   fault_lines_write("keyed.json", KEYED)
               ? 0
               : -1;
}

TEST_GROUP(make_files, fault_lines_close);
