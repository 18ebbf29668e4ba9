/* The table of sub-commands. */
#ifndef MOTE_HARNESS_COMMAND_H
#define MOTE_HARNESS_COMMAND_H

/* Every sub-command, X(name, usage, summary): a line here, and mote_command_NAME(argc, argv) in
   harness/command_NAME.c. argv[0] is the sub-command's name; the result is a mote_exit. */
#define MOTE_COMMANDS(X)                                                                       \
    X(list, "list methods|scenarios|fields [--json]",                                          \
      "the methods, scenarios and kinds of fields that there are")                             \
    X(letter, "letter W --triangles 11920 -o W.obj", "makes a letter's mesh")                  \
    X(check, "check SCENARIO [--json] [--out DIR]",                                            \
      "fingerprint; whether the active interval is what it says")                              \
    X(export, "export SCENARIO --frame K --out DIR [--method NAME[:key=value,...]]...",        \
      "writes a frame's deformed meshes and what methods say of them")                         \
    X(mesh, "mesh FILE [--json] [--strict]", "what a mesh is: counts, edges, parts, L")        \
    X(distance, "distance A.obj B.obj [--method NAME[:key=value,...]]... [--json] [--strict]", \
      "one query on two files")                                                                \
    X(approach,                                                                                \
      "approach SCENARIO --gaps FRAME:GAP,... [--every FRAMES] [--direction X,Y,Z] -o FILE",   \
      "writes the scenario with body 1 placed so that the gaps are as wished")                 \
    X(run,                                                                                     \
      "run SCENARIO... [--method NAME[:key=a|b,...]]... [--particles 1,2,4-8]\n"               \
      "           [--replicates K] [--frames A-B] [--out DIR] [--shard I/N] [--seed S]\n"      \
      "           [--timeout SECONDS] [--cache hot|evict] [--stride auto|K] [--jobs N]\n"      \
      "           [--until-ci 2%] [--budget SECONDS] [--fixed-seed] [--dry-run] [--force]\n"   \
      "           [--strict]",                                                                 \
      "measures cells, goes on where it stopped, writes DIR/summary.json")                     \
    X(simulate,                                                                                \
      "simulate SCENARIO --method NAME[:key=value,...] [--json] [--steps K] [--seed S]\n"      \
      "           [--density D] [--restitution E] [--tolerance T] [--gravity X,Y,Z]\n"         \
      "           [--time-step H] [--trace FILE.json] [--film FILE.gif]",                      \
      "closed loop: bodies move freely and collide where the method says so")                  \
    X(extremes, "extremes [--out DIR] [--quick]",                                              \
      "every method where numbers are tiny, huge, equal or degenerate")                        \
    X(dynamics,                                                                                \
      "dynamics [--out DIR] [--quick] [--jobs K] [--scene NAME] [--approaches K] [--keep]",    \
      "how often n particles let a body pass through, in the closed loop")                     \
    X(bodies, "bodies [--out DIR] [--quick]",                                                  \
      "several bodies by every method, over their number and density")                         \
    X(summarize, "summarize DIR [--format table|json|csv|gbench|gha|bencher]",                 \
      "the rows of a run, computed from its cells")                                            \
    X(compare, "compare BASE NEW [--format table|json] [--floor SHARE]",                       \
      "whether a run is worse than another: exit 0 no, 1 yes, 3 undecided")                    \
    X(instructions,                                                                            \
      "instructions SCENARIO --frames A-B --out DIR [--method NAME[:key=a|b,...]]...\n"        \
      "           [--particles 1,2,4-8]",                                                      \
      "what each method's frames execute, by callgrind; writes DIR/instructions.json")         \
    X(tune, "tune DIR [--best-fcl SCENARIO]",                                                  \
      "the best configuration of each method on each scenario of a run, or what was found")    \
    X(merge, "merge OUT DIR...", "puts the cells of several runs into one directory")          \
    X(history, "history [FILE] [--add DIR --why TEXT]",                                        \
      "draws the accepted references, or adds one")                                            \
    X(figures, "figures DIR", "draws the figures of a run again, measuring nothing")           \
    X(report, "report DIR", "a run as a page and as plain text, from what is stored")          \
    X(claims, "claims [--out DIR] [--quick]",                                                  \
      "measures every claim of the paper, writes DIR/claims.json")

#define MOTE_COMMAND_DECLARE(name, usage, summary)                                             \
    int mote_command_##name(int argc, char **argv);
MOTE_COMMANDS(MOTE_COMMAND_DECLARE)
#undef MOTE_COMMAND_DECLARE

#endif
