"""Sentences of documents that have numbers in them, and the stored results that these come from."""
from tables.ablation import launches
from tables.bodies import LETTERS, asked, bounds_of_body, gains, megabytes, step
from tables.characters import characters, exact_to_parts
from tables.claims import near_contact
from tables.counts import costliest_frames
from tables.engines import best_engine, best_engines, best_to_fcl, is_tree, times
from tables.impacts import continuous_to_sampled, energy_drifts, logged_impacts, long_questions, sums
from tables.loops import loops, missed_shares, missed_steps, particles, pass_through, query_times, worst_reports
from tables.number_text import digits, power, span
from tables.oracle import against_cgal
from tables.pairs import (CHARACTER_SCENES, LETTER_SCENES, best_fcl_to_default, evicted, exactness, fcl_to_paper, paper_to_exact,
                          processes_of_figure_3, slower_eights, tail, times_of_eight, tracked, tracked_on_letters,
                          worst_from_random_starts, wrong_rows)
from tables.races import QUIET, at_least, at_most, found_slowdowns, planted, seconds, unchanged
from tables.readers import animated_files, readers_total
from tables.reference import reference_row, times_of_particles
from tables.reliability import failures, furthest_off, searched, soaked
from tables.streamed import largest_share_of_tree, share_of_tree, stream_and_tree
from tables.tune import count_of_settings, fastest_not_asked, oriented_to_boxes
from tables.verdicts import convex, invented, oriented_bottom_up

CONTACTS = ("ww-contact", "mv-contact")
DEFORMING = ("ww", "mv", *CONTACTS)

# Document, sentence with places for values, and the values.
SENTENCES = [
    ("README.md", "(frames {} to {}, {:.0f} of them in contact, {} processes a method,", lambda root: (
        *reference_row(root, "certified")["frame_range"], reference_row(root, "certified")["contacts"],
        reference_row(root, "certified")["replicates"])),
    ("README.md", "Each point is the median of {} to {} processes", processes_of_figure_3),
    ("README.md", "the particles take less than 1/{:.0f}00 of FCL's time", lambda root: (
        reference_row(root, "particle-paper:n=5,start=fps")["ratio"]["value"] // 100,)),
    ("README.md", "in all frames of M-V, with cold caches, 1/{:.0f}", lambda root: (fcl_to_paper(root, "mv", "evict"),)),
    ("README.md", "Five of the paper's particles on each body take {:.2f} (W-W) and {:.2f} (M-V) of the time of the fastest exact query",
     lambda root: (paper_to_exact(root, "ww", 5), paper_to_exact(root, "mv", 5))),
    ("README.md", "On rigid T-T, asked for contact, three take {:.0f} times as long", lambda root: (paper_to_exact(root, "tt", 3),)),
    ("README.md", "({}) takes {} to {} times as long by the median and {} to {} by the mean (`make engines`)", lambda root: (
        best_engines(root, *DEFORMING),
        *(digits(value) for key in ("median", "mean") for value in span([times(root, scenario, key) for scenario in DEFORMING])))),
    ("README.md", "On rigid bodies, asked for contacts, the best engine takes {} to {} times as long by the median and {} to {} by the mean", lambda root: (
        digits(value) for key in ("median", "mean")
        for value in span([times(root, scenario, key) for scenario in ("tt", "rigid-ww", "rigid-mv")]))),
    ("docs/peers.md", "{} is the best of the others on `ww` and {} on `mv`, in {:.2f} and {:.2f} of FCL's time. They take {} times as "
     "long as `certified` on `ww` and {} times on `mv` ({} and {} by the mean), and {} and {} times as long as `aabb-tree`", lambda root: (
        *(best_engine(root, scenario) for scenario in CONTACTS), *(best_to_fcl(root, scenario) for scenario in CONTACTS),
        *(digits(times(root, scenario, key)) for key in ("median", "mean") for scenario in CONTACTS),
        *(digits(times(root, scenario) / times(root, scenario, wanted=is_tree)) for scenario in CONTACTS))),
    ("docs/peers.md", "`make tune PROFILE=full` measures {} settings of these engines on {} scenes", count_of_settings),
    ("docs/peers.md", "`make engines` has the fastest setting of each scene that both measure{};", fastest_not_asked),
    ("docs/peers.md", "the fastest of FCL's oriented volumes takes {:.0f} to {:.0f} times as long as its axis-aligned boxes", lambda root: (
        span([oriented_to_boxes(root, scenario) for scenario in ("ww", "mv", "bison-15k", "jumper-20k")]))),
    ("docs/findings.md", "takes {} times the median of `certified` on `tt`, {} times on the path of `ww`, where one test of two boxes "
     "decides most frames, and {} times on the path of `mv`; by the mean it takes {}, {} and {} times as long", lambda root: (
        digits(times(root, scenario, key)) for key in ("median", "mean") for scenario in ("tt", "rigid-ww", "rigid-mv"))),
    ("docs/peers.md", "takes {} times the median of `certified` on `tt`, {} times on the path of `ww` and {} times on the path of `mv`, and "
     "{}, {} and {} times its mean", lambda root: (
        digits(times(root, scenario, key)) for key in ("median", "mean") for scenario in ("tt", "rigid-ww", "rigid-mv"))),
    ("docs/peers.md", "FCL is the best of Debian's engines. It takes {} times as long as `certified` on `ww`, {} times on `mv` and {} times "
     "on `tt`", lambda root: (digits(times(root, scenario)) for scenario in ("ww", "mv", "tt-distance"))),
    ("docs/peers.md", "in each of the {} frames without one, RSS in {}. RSS bottom-up also misses {} of the {} contacts that {} other "
     "deforming scenarios have in the frames in which it was asked, and {} of {} on `spider`", oriented_bottom_up),
    ("docs/peers.md", "the best of the others takes {} (`ww`), {} (`mv`) and {} times (`tt-distance`) as long as `certified` for a "
     "distance, and {} (`ww`), {} (`mv`) and {} times (`tt`) for a contact", lambda root: (
        digits(near_contact(root, *asked)) for asked in (("r6", "ww"), ("r6", "mv"), ("r6", "tt-distance"), ("r7", "ww-contact"),
                                                         ("r7", "mv-contact"), ("r7", "tt")))),
    ("docs/peers.md", "{:,} random pairs of triangles, most of them hard, with errors of at most {} of the extent, and {:,} whole frames of "
     "`mv`, `tt-distance` and `ww`, at most {} L", against_cgal),
    ("docs/peers.md", "Bullet invents contacts on the slivers ({} and {}), on `spider` ({}), on `twist` ({}) and on `touch` ({})",
     lambda root: invented(root, "bullet-gimpact", "sliver-3", "sliver-6", "spider", "twist", "touch")),
    ("docs/peers.md", "ODE invents {} on `touch`", lambda root: invented(root, "ode", "touch")),
    ("docs/peers.md", "is wrong in {} of {} scenarios; {} of the {} contacts that it invents are on `shell`", convex),
    ("docs/impact.md", "Of {:,} approaches of all ten scenes in steps of 1, 3, 10 and 30 frames {} pass with continuous steps, {} surfaces "
     "intersect at any time looked at, and {} flights are unproven", lambda root: (
        sums(root, "continuous", "approaches", "passes_through", "intersecting", "floor_unproven"))),
    ("docs/impact.md", "Of {:,} intervals, {} impacts were missed or found after another, {} are false, {} brackets are too wide.", lambda root: (
        failures(root, "an impact missed", "random paths")[1],
        *(failures(root, check, "random paths")[0] for check in ("an impact missed", "a false impact", "a bracket above 1e-6")))),
    ("docs/impact.md", "In the last {:,} of them, {:,} have an impact; of {:,} that graze, {} were said to be grazing and {} undecided",
     logged_impacts),
    ("docs/impact.md", "by {} of itself in the median of these scenes and steps, by {} at most", lambda root: (
        map(power, energy_drifts(root)))),
    ("docs/impact.md", "Sampled at the ends of steps of 30 frames, {1} of {0:,} pass and {2:,} intersect", lambda root: (
        sums(root, "sampled", "approaches", "passes_through", "intersecting", least=30))),
    ("docs/impact.md", "finding every impact frame by frame takes {:.1f} times as long as a sample each frame, and in steps of ten "
     "frames {:.1f} times", lambda root: [continuous_to_sampled(root, "ww", step) for step in (1, 10)]),
    ("docs/impact.md", "At steps of 100 frames, 30 samples take {:.2f} to {:.2f} of the time of `certified` and miss {:.0f} of {:.0f} impacts",
     lambda root: long_questions(root, "impact-sampled:samples=30")),
    ("docs/impact.md", "Three samples miss {2:.0f} of them", lambda root: long_questions(root, "impact-sampled:samples=3")),
    ("docs/findings.md", "more than {:.0f}00 times as fast as FCL's trees with default settings, and {:.1f} % of their distances are exact in 200 frames "
     "around a contact; of all {:,} frames it is {:.1f} %", lambda root: (
        reference_row(root, "particle-paper:n=5,start=fps")["ratio"]["value"] // 100,
        100 * reference_row(root, "particle-paper:n=5,start=fps")["error"]["exact_rate"],
        *exactness(root, "ww", "particle-paper:n=5,start=fps"))),
    ("docs/findings.md", "In all frames of M-V they are {:.0f} times as fast, and {:.0f} times with cold caches", lambda root: (
        fcl_to_paper(root, "mv", cache) for cache in ("hot", "evict"))),
    ("README.md", "with its best settings it takes {:.2f} of its time in all frames", lambda root: (
        best_fcl_to_default(root, "ww"),)),
    ("README.md", "From random starts it is off by up to {:.2f} L and misses {:.1f} of {:.0f} contacts", lambda root: (
        worst_from_random_starts(root, "ww", 5))),
    ("README.md", "of all {:,} frames the paper's method answers {:.1f} % exactly", lambda root: (
        exactness(root, "ww", "particle-paper:n=5,start=fps"))),
    ("docs/findings.md", "exact in {:.0f} % of frames on `comb`, {:.0f} of {:.0f} contacts missed; in {:.0f} % on `jumper-330k`, "
     "{:.0f} of {:.0f} missed", lambda root: (*tracked(root, "comb"), *tracked(root, "jumper-330k"))),
    ("docs/findings.md", "on `comb` it is exact in {:.0f} % of the frames and misses {:.0f} of {:.0f} contacts, on `spider` in "
     "{:.0f} % ({:.0f} of {:.0f} missed)", lambda root: (*tracked(root, "comb"), *tracked(root, "spider"))),
    ("docs/findings.md", "they still miss contacts: {:.0f} of {:.0f} on `comb`, {:.0f} of {:.0f} of a character (`jumper-330k`)",
     lambda root: (*tracked(root, "comb")[1:], *tracked(root, "jumper-330k")[1:])),
    ("docs/findings.md", "exact in {:.1f} to {:.0f} % of the frames of ten scenes of letters (`mv`, `tw`, `twist`, `vv` and the six sizes of "
     "`ww`), and misses {:.0f} of their {:,.0f} contacts", tracked_on_letters),
    ("docs/findings.md", "Of the {} rows of `certified`, `aabb-tree` and the engines of others in this run, {} have a distance that is "
     "not exact or a wrong verdict", wrong_rows),
    ("docs/findings.md", "with 8 particles it takes longer than `certified` on {} of {} scenes", slower_eights),
    ("docs/findings.md", "it is exact, and takes {:.1f} to {:.1f} times as long as the paper's mode with 8 particles; on characters, where the paper's "
     "mode misses up to all of the contacts, {:.1f} to {:.1f} times as long", lambda root: (
        *span(times_of_eight(root, LETTER_SCENES)), *span(times_of_eight(root, CHARACTER_SCENES)))),
    ("docs/findings.md", "one pass over them takes {:.2f} of the time of a tree that is refitted on `ww`, and {:.2f} where it gains least (`{}`)",
     lambda root: (share_of_tree(root, "12k-letter"), *largest_share_of_tree(root))),
    ("docs/findings.md", "it takes {} µs a frame on the letters of `ww`, `aabb-tree` {}; {} and {} on `twist`, {} and {} on `fast-100`, "
     "{} and {} on `jump`, {} and {} on `still`, {} and {} on `fast-5`, {} and {} on letters of 100,000 triangles. Cloth at rest on "
     "a letter, which is near it everywhere, takes {} and {}", lambda root: (
        stream_and_tree(root, "12k-letter", "twist", "fast-100", "jump", "still", "fast-5", "100k-letter", "cloth-11920"))),
    ("docs/findings.md", "only {:.1f} to {:.1f} times as fast as `aabb-tree` at a million triangles", lambda root: (
        span([1 / share_of_tree(root, case) for case in ("1m-letter", "1m-leaf")]))),
    ("docs/findings.md", "With 8 launches in each query it is exact in {:.0f} % of the frames on `comb` and misses {:.1f} contacts a run, for "
     "{:.1f} times the time", launches),
    ("docs/characters.md", "Side by side the bison take {} µs instead of {}, and their 95th percentile is {} µs", lambda root: (
        characters(root)["bison-15k"][0], characters(root)["bison-near-15k"][0], characters(root)["bison-15k"][1])),
    ("docs/characters.md", "where bones alone move a body, an exact answer costs {:.1f} to {:.1f} times what rigid parts do",
     exact_to_parts),
    ("docs/characters.md", "Of {} animated files of Debian's `assimp-testmodels` {} are read, {} of them without an edge of more than two faces",
     animated_files),
    ("docs/benchmarking.md", "`make readers` reads each of the {} files", lambda root: readers_total(root)[:1]),
    ("docs/benchmarking.md", "mote reads {} as meshes and refuses {}", lambda root: readers_total(root)[1:]),
    ("docs/findings.md", "{:.1f} times its median in one of twenty frames of `flat`", lambda root: (tail(root, "flat"),)),
    ("docs/findings.md", "{:.1f} (`ww`), {:.1f} (`mv`) and {:.0f} times (`tt`, asked for contact) as long as hot", lambda root: (
        evicted(root, scenario) for scenario in ("ww", "mv", "tt"))),
    ("docs/findings.md", "passes through the other in {} % of 1,000 approaches; with 3 particles it is {} %",
     lambda root: (pass_through(root, "ww", 5), pass_through(root, "ww", 3))),
    ("docs/findings.md", "for {:.1f} (`mv`) to {:.1f} times (`ww`) the time of the particles", lambda root: (
        times_of_particles(root, "mv"), times_of_particles(root, "ww"))),
    ("docs/findings.md", "up to {} % of approaches pass through at n = 3 (`twist`), up to {} % still at n = 16 (`comb`)",
     lambda root: (pass_through(root, "twist", 3), pass_through(root, "comb", 16))),
    ("docs/findings.md", "{} % of the bodies pass through with 3 particles and {} % with 5", lambda root: (
        pass_through(root, "ww", 3), pass_through(root, "ww", 5))),
    ("docs/findings.md", "it is up to {} % and {} %", lambda root: (
        pass_through(root, "twist", 3), pass_through(root, "comb", 3))),
    ("docs/findings.md", "the particles miss {:.0f} to {:.0f} % of the frames in contact on T-T, M-V and W-W, report a "
     "contact up to {} frames after it began, and the bodies penetrate by up to {:.2f} L", lambda root: (
        100 * min(missed_shares(root, (3, 4, 5))), 100 * max(missed_shares(root, (3, 4, 5))), *worst_reports(root))),
    ("docs/findings.md", "up to {:.0f} % missed (`comb`), {} frames late (`ww-100k`), and {:.2f} L deep (`bunny`)",
     lambda root: (100 * max(missed_shares(root, (3, 4, 5), True)), *worst_reports(root, True))),
    ("docs/findings.md", "With 16 particles, {} of {:,} approaches passes through on the paper's scenes, and at most "
     "{:.1f} % of the frames in contact are missed; on `comb` it is {:.0f} %", lambda root: (
        *(sum(int(row[key]) for row in loops(root, particles(16))) for key in ("passes_through", "approaches")),
        100 * max(missed_shares(root, (16,))), 100 * max(missed_shares(root, (16,), True)))),
    ("docs/findings.md", "tracked and certified {:.0f} to {:.0f} µs, the paper's mode with 5 particles {:.0f} to "
     "{:.0f} µs, FCL {:,.0f} to {:,.0f} µs", lambda root: (
        *query_times(root, "particle:n=8", "certified"), *query_times(root, *particles(5)),
        *(round(time, -2) for time in query_times(root, "fcl-aabb:seed=previous,queue=64")))),
    ("docs/certified.md", "{} of the {} frames of `ww` with the most pairs of leaves touch. They lie between frames {} and {}, in which the "
     "letters are far from each other. They deform {:.1f} times as many blocks as the middle fifth, but leave {:.0f} times as many rows and "
     "{:.0f} times as many pairs of leaves undecided", costliest_frames),
    ("docs/certified.md", "On an idle machine a step of these letters takes {:.1f} ms", lambda root: (
        step(root, LETTERS[4], "certified") / 1e6,)),
    ("docs/certified.md", "(with the trees as they are split now, {:,.0f} of the letters)", lambda root: asked(root, 4)[:1]),
    ("docs/certified.md", "Of {1:,} queries {0} were beyond 1e-12 L and {2} lower bounds above the truth, and {4} of {5:,} checks of a vertex in a "
     "deformed box failed", lambda root: (
        value for check in ("certified beyond 1e-12 L", "a lower bound above the truth", "a vertex outside of a box")
        for value in failures(root, check, "random skins"))),
    ("docs/benchmarking.md", "certified trees ({:.2f} µs a body)", lambda root: (bounds_of_body(root),)),
    ("docs/benchmarking.md", "leave out {:.0f} % of the pairs of the densest box of 1,000 letters", lambda root: asked(root, 4)[1:]),
    ("docs/findings.md", "takes at most {:.0f} MB with `certified` and {:.1f} GB with `refit=every`; with 10,000 letters "
     "of 4 shapes `certified` takes {:.0f} MB at 4 near pairs a body", lambda root: (
        max(megabytes(root, scene) for scene in LETTERS.values()),
        megabytes(root, LETTERS[4], "fcl-aabb:refit=every") / 1e3, megabytes(root, "letters-10000-4"))),
    ("docs/findings.md", "takes {:.2f}, {:.2f} and {:.2f} of the time with `threads=2` at 0.1, 1 and 4 near pairs a body, {:.2f}, "
     "{:.2f} and {:.2f} with `ahead=3`, and {:.2f}, {:.2f} and {:.2f} with both", lambda root: (
        1 / gain for options in ("threads=2", "ahead=3", "threads=2,ahead=3") for gain in gains(root, options))),
    ("docs/findings.md", "of {:,} distances that it searched to the end, {} lay farther than 1e-12 L from it. Of {:,} lower bounds, with "
     "those of searches that were stopped early, {} lay above it", lambda root: (
        *reversed(searched(root)), *reversed(failures(root, "a lower bound above the truth")))),
    ("docs/findings.md", "the largest error of `certified` is {} L", lambda root: (power(furthest_off(root)[0]),)),
    ("docs/architecture.md", "and {} L in the worst of the random scenarios", lambda root: (power(furthest_off(root)[1]),)),
    ("docs/findings.md", "Its lower bound lies at most {} L below the distance", lambda root: (
        power(furthest_off(root)[1]),)),
    ("docs/findings.md", "in [one random scene](#how-far-an-exact-answer-can-be-trusted) a lower bound {} L below the "
     "distance", lambda root: (power(furthest_off(root)[1]),)),
    ("docs/findings.md", "random scenes in {:.1f} % of {:,} frames ({:,} missed). The paper's particles, five a body, are "
     "exact in {:.0f} % of {:,} such frames and miss {:,} contacts; `aabb-tree` is exact in all, and `certified` is "
     "farther off than 1e-12 L in {}", lambda root: (
        *soaked(root, "particle:n=8"), *soaked(root, "particle-paper:n=5"),
        searched(root)[0])),
    ("docs/findings.md", "it misses {} frames in contact on the paper's scenes, {} on `twist` and {} on the comb",
     lambda root: (
        missed_steps(root, "particle:n=8", "tt", "mv", "ww"), missed_steps(root, "particle:n=8", "twist"),
        missed_steps(root, "particle:n=8", "comb"))),
    ("docs/findings.md", "{}, {} and {} % pass through at n = 3, 4 and 5 with the inverse law", lambda root: (
        pass_through(root, "ww", n, "inverse") for n in (3, 4, 5))),
    ("docs/findings.md", "{}, {} and {} % with the inverse square", lambda root: (
        pass_through(root, "ww", n, "inverse-square") for n in (3, 4, 5))),
    ("docs/benchmarking.md", "{} of {} unchanged builds were called faster or slower on an idle machine, and {} of {} "
     "beside a compiler (at most {:.1f} % each, with 95 % confidence)", lambda root: (
        *(value for place in QUIET for value in unchanged(root, (place,))),
        max(at_most(*unchanged(root, (place,))) for place in QUIET))),
    ("docs/benchmarking.md", "On the idle machine {} of {} races named a slowdown of 2 % in the certified query, {} of "
     "{} one in the particle sweep, and {} of {} one in the reading of the clock; beside a compiler {} of {}, {} of {} "
     "and {} of {} did, and of 5 % {} of {}, {} of {} and {} of {} (at least {:.0f} % each, with 95 % confidence)", lambda root: (
        *(value for found in found_slowdowns(root) for value in found),
        min(at_least(*found) for found in found_slowdowns(root)))),
    ("docs/benchmarking.md", "{} of {} races named a slowdown of 3 % or more, wherever it was planted", lambda root: (
        planted(root, 3, 10))),
    ("docs/benchmarking.md", "Of 1 %, which is where a change begins to count, {} of {} did: {} of {} on the idle machine, {} "
     "of {} beside a compiler", lambda root: (
        *planted(root, 1, 1), *(value for place in QUIET for value in planted(root, 1, 1, (place,))))),
    ("docs/benchmarking.md", "A race of these two rows takes {:.0f} to {:.0f} s", seconds),
]
