/* The table of commands, from which the program, its help, the manual and the completion are
   made. */
#ifndef MOTE_HARNESS_COMMAND_H
#define MOTE_HARNESS_COMMAND_H

#include "harness/base/options.h"

/* Every command, X(name, measures, arguments, summary, options): a line here, and in
   harness/command/command_NAME.c mote_command_NAME(argc, argv) and its options. argv[0] is the
   command's name; the result is a mote_exit. measures: whether it measures times; arguments:
   the required arguments. */
#define MOTE_COMMANDS(X)                                                                       \
    X(list, false, "methods|scenarios|fields",                                                 \
      "lists the methods, the scenarios or the kinds of fields", mote_options_list)            \
    X(letter, false, "LETTER --triangles COUNT -o FILE", "makes the mesh of a capital letter", \
      mote_options_letter)                                                                     \
    X(sequence, false, "cloth|banner|jelly --triangles COUNT --out DIR",                       \
      "simulates a body that no field describes, and writes a scenario of its positions",      \
      mote_options_sequence)                                                                   \
    X(check, false, "SCENARIO",                                                                \
      "prints a scenario's fingerprint and distances, and checks its active interval",         \
      mote_options_check)                                                                      \
    X(export, false, "SCENARIO --frame K --out DIR",                                           \
      "writes the deformed meshes of a frame, and methods' answers for it",                    \
      mote_options_export)                                                                     \
    X(mesh, false, "FILE",                                                                     \
      "describes a mesh: counts, edges, components, convex parts, quality, L",                 \
      mote_options_mesh)                                                                       \
    X(distance, false, "A.obj B.obj",                                                          \
      "computes the distance of two meshes where their files place them",                      \
      mote_options_distance)                                                                   \
    X(approach, false, "SCENARIO --gaps FRAME:GAP,... -o FILE",                                \
      "writes a scenario with body 1 moved so that the gaps are those given",                  \
      mote_options_approach)                                                                   \
    X(run, true, "SCENARIO...|--pair A.obj B.obj",                                             \
      "measures methods on scenarios, resumes what was stopped, writes DIR/summary.json",      \
      mote_options_run)                                                                        \
    X(simulate, true, "SCENARIO... --method NAME[:key=value,...]",                             \
      "simulates the closed loop: bodies move freely and collide where the method says so",    \
      mote_options_simulate)                                                                   \
    X(extremes, true, "",                                                                      \
      "tries every method where numbers are tiny, huge, equal or degenerate",                  \
      mote_options_extremes)                                                                   \
    X(dynamics, true, "",                                                                      \
      "measures how often n particles let a body pass through, in the closed loop",            \
      mote_options_dynamics)                                                                   \
    X(bodies, true, "",                                                                        \
      "measures scenes of several bodies by every method, over their number and density",      \
      mote_options_study)                                                                      \
    X(summarize, false, "DIR", "prints the rows of a run, computed from its cells",            \
      mote_options_summarize)                                                                  \
    X(compare, false, "BASE NEW",                                                              \
      "says whether NEW is worse than BASE: exit status 0 no, 1 yes, 3 undecided",             \
      mote_options_compare)                                                                    \
    X(race, true, "A B SCENARIO... --method NAME[:key=value,...]",                             \
      "two builds of mote (programs, or folders of each linked in several orders) measure in " \
      "turn: is B slower? exit status 0 no, 1 yes, 3 undecided",                               \
      mote_options_race)                                                                       \
    X(instructions, false, "SCENARIO --frames A-B --out DIR",                                  \
      "counts the instructions of each method's frames, by callgrind; writes "                 \
      "DIR/instructions.json",                                                                 \
      mote_options_instructions)                                                               \
    X(tune, false, "DIR",                                                                      \
      "prints the best configuration of each method on each scenario of a run",                \
      mote_options_tune)                                                                       \
    X(merge, false, "OUT DIR...", "puts the cells of several runs into one directory",         \
      mote_options_none)                                                                       \
    X(history, false, "[FILE]",                                                                \
      "draws references and races of FILE (default: results/history.csv), or adds a "          \
      "reference",                                                                             \
      mote_options_history)                                                                    \
    X(figures, false, "DIR", "draws the figures of a run again, measuring nothing",            \
      mote_options_none)                                                                       \
    X(report, false, "DIR", "makes a page and a Markdown text of a run, from what is stored",  \
      mote_options_none)                                                                       \
    X(site, false, "DIR... -o DIR",                                                            \
      "makes a page and a CSV file of several runs, from their summaries", mote_options_site)  \
    X(claims, true, "", "measures every claim of the paper, writes DIR/claims.json",           \
      mote_options_study)

#define MOTE_COMMAND_DECLARE(name, measures, arguments, summary, options)                      \
    int mote_command_##name(int argc, char **argv);                                            \
    extern const mote_option options[];
MOTE_COMMANDS(MOTE_COMMAND_DECLARE)
#undef MOTE_COMMAND_DECLARE

#endif
