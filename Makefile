# The front door. Each target does all of its own set-up: `make bench` or `make test` in a fresh
# clone is enough.
#
#   make bench [PROFILE=quick|paper|full] [OUT=DIR]   run the experiments, draw, show the best rows
#   make sweep [OUT=DIR]                              time and memory over triangles, 1k to 1M
#   make test                                         release tests, then ASan and UBSan
#   make test-long                                    the tests that make test leaves out for their time
#   make page                                         the viewer of reports, bundled by npm
#   make test-page                                   the report's page, in headless Chromium

#   make figures [OUT=DIR]                            draw again from what is stored
#   make report [OUT=DIR]                             write report.html and report.md again
#   make record [OUT=DIR]                             keep a run's summary in results/records
#   make engines [PROFILE=quick] [OUT=DIR]           other engines and ours, asked the same
#   make fcl-flags [FCL_DIR=DIR] [FCL_FLAGS=] [OUT=]  Debian's FCL against one compiled by our flags
#   make verdicts [PROFILE=quick|large|full] [OUT=DIR]  contacts missed and invented in every scenario
#   make auto [PROFILE=quick|full] [OUT=DIR]         auto beside certified and stream in every scenario
#   make ratios [OUT=DIR] [AVX2=no]                  stream's time to the box tree's and FCL's
#   make oracle [PROFILE=quick|full] [OUT=DIR]       triangles and frames against exact answers
#   make oracle METHOD=NAME [PLUGIN=FILE.so]          any method's answers on frames, against exact ones
#   make tune [PROFILE=quick|full] [OUT=DIR]         every baseline's configurations; the best
#   make ingredients [PROFILE=quick|full] [OUT=DIR]  what each part of the tracked particles adds
#   make ablation [PROFILE=quick|full] [OUT=DIR]     what each step of the certified query brings
#   make counts [OUT=DIR]                            what a certified query looks at: boxes, leaves, faces
#   make readers [OUT=DIR] [MODELS=DIR]              our readers of mesh files beside assimp's
#   make characters [MODELS=DIR]                     which animated files are read as characters
#   make character-speed [PROFILE=quick|full] [OUT=] characters: certified, aabb-tree, FCL
#   make certify [PROFILE=quick|full] [OUT=DIR]      is a proven bound ever above the truth?
#   make skins [PROFILE=quick|full] [OUT=DIR]        random bones and morph targets against another method
#   make streamed [PROFILE=quick|full] [OUT=DIR]     are queries of arrays of positions ever wrong?
#   make impacts [PROFILE=quick|full] [OUT=DIR]      is an impact ever missed, or false?
#   make impact-speed [PROFILE=quick|full] [OUT=DIR] impacts within steps: certified, samples, others
#   make soak HOURS=H [SEED=S] [OUT=DIR]             random scenarios against the truth
#   make reliability [PROFILE=quick|full] [PLANT=1]  what was tried, how often, what failed
#   make fuzz [SECONDS=60] [TARGET=mesh] [RECORD=1]  what comes from outside, fuzzed (libFuzzer)
#   make determinism [RUNS=56]                       one hash over all answers: compilers, threads
#   make extremes [PROFILE=quick|full] [OUT=DIR]     every method where numbers are tiny, huge, equal
#   make dynamics [PROFILE=quick|full] [OUT=DIR]     do n particles let a body pass? the closed loop
#   make bodies [PROFILE=quick|full] [OUT=DIR]       several bodies: time, memory, missed contacts
#   make documents                                  tables in documents, from results/reference and records
#   make perf-check                                 measure again, compare with results/reference
#   make perf-counts                                the same without times: counts, bytes, accuracy
#   make perf-ab [BASE=REVISION]                    two revisions side by side: is this one slower?
#   make perf-study [RACES=200] [PLANTED=40] [OUT=]  how often perf-ab's verdicts are wrong; hours;
#                                                   ONLY="idle:2": slowdowns of 2 % on an idle machine
#   make test-perf                                  plant changes: are they caught, and nothing else?
#   make test-kill                                  200 random kill -9 of a sweep: is a cell lost?
#   make test-statistics                            what intervals cover on simulated runs
#   make perf-accept WHY="..."                        make what is measured the reference
#   make claims [OUT=DIR]                             measure the claims of the paper
#   make check-abi BASE=REVISION                    does a program linked with that revision's library run?
#   make interface-accept                           renew the list of what libmote promises
#   make test-library                               the library alone: gcc, clang, musl-gcc
#   make test-stranger                              a method, field, scenario from docs/extending.md alone
#   make test-cluster                               a Slurm of one node here: array, kill, merge
#   make test-exports                               exports read by jq, pandas, scipy; the schema of scenarios
#   make test-bare                                   bench and test as on a fresh Debian 12
#   make install [prefix=/usr/local] [DESTDIR=]      program, library, headers, manual
#   make uninstall [prefix=/usr/local] [DESTDIR=]    removes exactly what make install put there
#   make deb                                        Debian packages of these, in build/deb
#   make test-deb                                   installed, used and removed on a bare Debian 12
#   make mutation [FILES=GLOB] [COUNT=120] [OUT=DIR] small errors, planted one by one: does a test fail?
#   make coverage [OUT=DIR]                         branches that tests take: core 99 %, harness 94 %
#   make lint [DEEP='core|harness'], check-static    clang-tidy, its analyzer on DEEP (core); cppcheck
#   make check-threads, valgrind                     ThreadSanitizer over what has threads; a smoke run
#   make deps, make build, make build-tests, make clean

PROFILE ?= paper
OUT ?= results/$(PROFILE)
# Where a study of its own writes: results/STUDY, unless OUT is given.
out = $(if $(filter file,$(origin OUT)),results/$(1),$(OUT))
JOBS ?= $(shell nproc)
# One test more than there are cores, since many spend most of their time waiting.
TESTS_AT_ONCE = $(shell expr $(JOBS) + 1)
BUILD = build
MOTE = $(BUILD)/mote

# One make at a time configures or compiles.
locked = mkdir -p $(BUILD) && cmake/locked.sh $(BUILD)
# $(call configure,PRESET): silent, unless it fails.
configure = $(locked) sh -c 'cmake --preset $(1) > $(BUILD)/configure.log 2>&1 || \
    { cat $(BUILD)/configure.log; exit 1; }'
# $(call compile,FOLDER[,TARGET...]): everything where no target is named.
compile = $(locked) cmake/compile.sh $(1) $(JOBS) $(2)
# A word for the shell, whatever it holds.
quoted = '$(subst ','\'',$(1))'

# Sanitizers stop at the first error, and FCL's own never-freed statics are not ours to report.
SANITIZER = ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1 UBSAN_OPTIONS=print_stacktrace=1

.DEFAULT_GOAL := build
.NOTPARALLEL: # JOBS is for what runs inside a target
.PHONY: deps build build-tests bench test figures perf-check perf-accept test-perf test-kill \
    test-statistics oracle character-speed tune ingredients ablation certify skins streamed impacts soak reliability extremes dynamics claims \
    format lint clean

# packages.txt lists what building and running mote needs, cmake/packages-NAME.txt what deps-NAME adds.
deps:
	@cmake/deps.sh packages.txt

deps-%:
	@cmake/deps.sh packages.txt cmake/packages-$*.txt

# The program alone. CMake leaves out the tests where their libraries are missing (deps-test).
build: deps
	@$(call configure,release)
	@$(call compile,$(BUILD),mote)

build-tests: deps-test
	@$(call configure,release)
	@$(call compile,$(BUILD))

# tests/CMakeLists.txt says which tests are long. Continuous integration runs both targets.
.PHONY: test-long
test: LABEL = -LE long
test-long: LABEL = -L long
test test-long: build-tests
	cd $(BUILD) && ctest --no-tests=error --output-on-failure -j $(TESTS_AT_ONCE) $(LABEL)
	@$(call configure,asan)
	@$(call compile,build-asan)
	cd build-asan && $(SANITIZER) ctest --no-tests=error --output-on-failure -j $(TESTS_AT_ONCE) $(LABEL)

# A program of tests/ by itself, and the one that it calls.
program-%: deps-test
	@$(call configure,release)
	@$(call compile,$(BUILD),mote $*)

# As on a machine where nobody has installed anything: see tests/scripts/bare.sh.
.PHONY: test-bare
test-bare:
	@cmake/deps.sh cmake/packages-bare.txt
	@tests/scripts/bare.sh 'make bench PROFILE=quick' 'tests/scripts/all_methods.sh build/mote' \
	    'make test' 'make test-long'

bench: build page
	@harness/scripts/bench.sh $(MOTE) $(PROFILE) $(OUT)

.PHONY: sweep
sweep: build
	@harness/scripts/bench.sh $(MOTE) sweep $(call out,sweep)

# Other engines and ours, asked for contacts and for distances of the same frames.
.PHONY: engines
engines: build
	@harness/scripts/bench.sh $(MOTE) engines$(if $(filter quick,$(PROFILE)),-quick) \
	    $(call out,engines)

# FCL as Debian compiles it against FCL compiled here.
.PHONY: fcl-flags
fcl-flags: build deps-fcl
	@FCL_DIR=$(call quoted,$(FCL_DIR)) FCL_FLAGS=$(call quoted,$(FCL_FLAGS)) \
	    harness/scripts/fcl_flags.sh $(BUILD) $(call out,fcl-flags)

# Contacts that each engine misses or invents, over every built-in scenario.
.PHONY: verdicts
verdicts: build
	@harness/scripts/verdicts.sh $(MOTE) $(PROFILE) $(call out,verdicts)

# Method auto beside the two that it chooses from, in every built-in scenario (docs/architecture.md).
.PHONY: auto
auto: build deps-test
	@harness/scripts/auto.sh $(MOTE) $(PROFILE) $(call out,auto)

# Method stream's time to that of the box tree and of FCL, told positions alone; also compiled for AVX2 only.
AVX2 ?= yes
.PHONY: ratios
ratios: build deps-test $(if $(filter yes,$(AVX2)),build-avx2)
	@harness/scripts/ratios.sh $(MOTE) '$(if $(filter yes,$(AVX2)),build-avx2/mote)' $(call out,ratios)

.PHONY: build-avx2
build-avx2: deps
	@mkdir -p build-avx2
	@cmake -S . -B build-avx2 -DCMAKE_BUILD_TYPE=Release -DMOTE_FORCE_ISA=x86-64-v3 \
	    > build-avx2/configure.log || { cat build-avx2/configure.log; exit 1; }
	@$(call compile,build-avx2,mote)

# With METHOD, only the frames, by these methods, also of the shared libraries in PLUGIN.
PLUGIN ?=
METHOD ?=
oracle: program-oracle $(if $(METHOD),,program-oracle_cgal)
	@mkdir -p $(OUT)
ifeq ($(METHOD),)
	@$(BUILD)/tests/oracle_cgal $(if $(filter quick,$(PROFILE)),--frames 100,--pairs 190000 --frames 1000)
	@$(BUILD)/tests/oracle --out $(OUT)/oracle.json \
	    $(if $(filter quick,$(PROFILE)),--pairs 190000 --stride 16,--pairs 11400000 --stride 1)
else
	@$(BUILD)/tests/oracle --out $(OUT)/oracle-methods.json \
	    --stride $(if $(filter quick,$(PROFILE)),16,1) \
	    $(foreach file,$(PLUGIN),--plugin $(call quoted,$(file))) \
	    $(foreach method,$(METHOD),--method $(call quoted,$(method)))
endif

# On the models that assimp is tested with, or those in MODELS.
MODELS ?= /usr/share/assimp/models
.PHONY: readers
readers: program-readers deps-readers
	@$(BUILD)/tests/readers --out $(call out,readers) $(call quoted,$(MODELS))

.PHONY: characters
characters: program-characters deps-readers
	@$(BUILD)/tests/characters $(call quoted,$(MODELS))

character-speed: build deps-test
	@harness/scripts/character_speed.sh $(MOTE) $(PROFILE) $(call out,character-speed)

tune: build
	@harness/scripts/tune.sh $(MOTE) $(PROFILE) $(call out,tune)

ingredients: build
	@harness/scripts/ingredients.sh $(MOTE) $(PROFILE) $(call out,ingredients)

ablation: build
	@harness/scripts/ablation.sh $(MOTE) $(PROFILE) $(call out,ablation)

# Of the letters of several sizes, frames in or near contact.
.PHONY: counts
counts: OUT_OF_COUNTS = $(call out,counts)
counts: COUNT = $(MOTE) run --method certified --replicates 1 --stride 1 --no-summary --out $(OUT_OF_COUNTS)
counts: build deps-test
	@$(COUNT) ww mv twist ww-1m >/dev/null
	@$(COUNT) ww-1k ww-10k --frames 1100-1300 >/dev/null
	@$(COUNT) ww-100k --frames 100-300 >/dev/null
	@harness/scripts/counts.py $(OUT_OF_COUNTS)

certify: program-certify
	@mkdir -p $(OUT)
	@$(BUILD)/tests/certify --out $(OUT)/certify.json \
	    --queries $(if $(filter quick,$(PROFILE)),25000,1000000)

skins: program-skins
	@mkdir -p $(OUT)
	@$(BUILD)/tests/skins --out $(OUT)/skins.json \
	    --queries $(if $(filter quick,$(PROFILE)),25000,1000000)

streamed: program-streamed
	@mkdir -p $(OUT)
	@$(BUILD)/tests/streamed --out $(OUT)/streamed.json \
	    --queries $(if $(filter quick,$(PROFILE)),25000,1000000)

impacts: program-impacts program-impact_steps
	@mkdir -p $(OUT)
	@$(BUILD)/tests/impacts --out $(OUT)/impacts.json \
	    --queries $(if $(filter quick,$(PROFILE)),5000,100000)
	@$(BUILD)/tests/impact_steps --out $(OUT)/impact-steps.csv \
	    --intervals $(if $(filter quick,$(PROFILE)),20,100) ww mv rigid-ww rigid-mv

.PHONY: impact-speed
impact-speed: build
	@harness/scripts/impact_speed.sh $(MOTE) $(PROFILE) $(call out,impact-speed)

# PLANT=1 plants a wrong answer, a lost row and a leak, which must be found; ONLY="kills fuzz" runs some of the studies.
PLANT ?=
reliability: build-tests program-kills build-fuzz
	@$(call configure,asan)
	@$(call compile,build-asan,test_faults test_allocations) > /dev/null
	@$(call configure,tsan)
	@$(call compile,build-tsan,answers) > /dev/null
	@mkdir -p results
	@JOBS=$(JOBS) ONLY="$(ONLY)" tests/scripts/reliability.sh $(BUILD) build-asan build-fuzz build-tsan \
	    $(if $(filter quick,$(PROFILE)),quick,full) \
	    $(call out,reliability) \
	    $(if $(PLANT),plant)

RUNS ?= 56
.PHONY: determinism
determinism: build deps-test
	@tests/scripts/portability.sh .
	@tests/scripts/determinism.sh $(BUILD) $(RUNS) $(JOBS)

# As many targets at a time as there are cores. RECORD=1 adds the hours to results/fuzz.csv.
SECONDS ?= 60
TARGET ?=
RECORD ?=
.PHONY: fuzz build-fuzz
build-fuzz: deps-test deps-fuzz
	@$(call configure,fuzz)
	@$(call compile,build-fuzz,fuzz_targets) > /dev/null

fuzz: build-fuzz
	@TARGET="$(TARGET)" tests/scripts/fuzz.sh build-fuzz $(SECONDS) $(JOBS) \
	    $(call out,fuzz) $(SEED)
	@$(if $(RECORD),tests/scripts/log_fuzz.sh $(call out,fuzz)/fuzz.tsv)

# Cases that fail are shrunk and kept in OUT/cases.
HOURS ?= 0.1
SEED ?= 1
soak: program-soak
	@mkdir -p results
	@$(BUILD)/tests/soak --hours $(HOURS) --seed $(SEED) \
	    --out $(call out,soak)

extremes: build
	@$(MOTE) extremes --out $(call out,extremes) \
	    $(if $(filter quick,$(PROFILE)),--quick)

.PHONY: bodies
bodies: build
	@$(MOTE) bodies --out $(call out,bodies) \
	    $(if $(filter quick,$(PROFILE)),--quick)

dynamics: build
	@$(MOTE) dynamics --out $(call out,dynamics) \
	    --jobs $(JOBS) $(if $(filter quick,$(PROFILE)),--quick)

perf-check: build deps-valgrind
	@harness/scripts/perf.sh check $(MOTE) results/perf-check

.PHONY: perf-counts perf-ab perf-study
perf-counts: build deps-valgrind
	@harness/scripts/perf.sh counts $(MOTE) results/perf-counts

# BASE: by default the commit of the accepted reference. CHANGED=1: answers may differ.
BASE ?=
CHANGED ?=
perf-ab: build deps-valgrind
	@CHANGED=$(CHANGED) harness/scripts/perf_ab.sh $(BUILD) $(call out,perf-ab) $(call quoted,$(BASE))

# As many races of a build against itself, and of each planted slowdown; hours for all, and what was
# raced stays in OUT/races.csv.
RACES ?= 200
PLANTED ?= 40
perf-study: program-race_study program-race_planted
	@harness/scripts/perf_study.sh $(BUILD) $(call out,perf-study) $(RACES) $(PLANTED) \
	    $(call quoted,$(ONLY))

test-perf: program-perf_planted
	@$(BUILD)/tests/perf_planted results/test-perf

test-kill: program-kills
	@rm -rf results/test-kill
	@$(BUILD)/tests/kills results/test-kill

test-statistics: program-interval_coverage
	@$(BUILD)/tests/interval_coverage

perf-accept: build deps-valgrind
	@[ -n "$(WHY)" ] || { echo 'perf-accept: say why: make perf-accept WHY="..."' >&2; exit 2; }
	@harness/scripts/perf.sh accept $(MOTE) results/perf-check "$(WHY)"

claims: build
	@$(MOTE) claims --out $(call out,claims)

figures: build
	@$(MOTE) figures $(OUT)

.PHONY: report record
report: build page
	@$(MOTE) report $(OUT)

# With OUT, keeps that run; without, runs all studies that are stale (STALE=1 says so; LIST=1 runs none).
STALE ?=
LIST ?=
BUSY ?=
record: $(if $(filter command,$(origin OUT)),,build) $(if $(LIST),,deps-test)
ifeq ($(origin OUT),command line)
	@harness/scripts/record.sh $(call quoted,$(OUT)) results/records
else
	@ONLY=$(call quoted,$(ONLY)) HOURS=$(call quoted,$(if $(filter file,$(origin HOURS)),,$(HOURS))) BUSY=$(BUSY) JOBS=$(JOBS) PROGRAM=$(MOTE) \
	    harness/scripts/studies.sh harness/scripts/studies.tsv results/records results/record $(if $(LIST),list) || \
	    status=$$?; $(if $(LIST),,harness/scripts/documents.py . || status=$$?;) exit $${status:-0}
endif

# Tables and numbers of the documents are those of results/reference and of the newest records.
.PHONY: documents
documents: deps-test
	@harness/scripts/documents.py .

# The replay of reports: bundled where npm is, left out where it is not.
.PHONY: page test-page
page:
	@plots/page/build.sh $(BUILD)/page

test-page: build deps-page
	@plots/page/build.sh $(BUILD)/page
	@node tests/scripts/page.mjs $(MOTE) $(BUILD)/page/replay.js "$$(command -v chromium)" $(BUILD)/page/test

SOURCES = $(wildcard $(foreach folder,core baselines datasets harness tests cmake,\
    $(foreach kind,c h cpp hpp,$(addsuffix .$(kind),$(addprefix $(folder)/,* */* */*/* */*/*/*)))))

format: deps-lint
	@clang-format --dry-run -Werror $(SOURCES)

# clang-tidy stumbles over flags that only gcc knows; assertions tell its analyzer what holds. clang's own
# warnings are errors. The analyzer takes most of the time: by default it looks at core alone, and not at the rest.
DEEP ?= core
REST = $(filter-out $(subst |, ,$(DEEP)),core baselines harness datasets)
TIDY = run-clang-tidy -quiet -j $(JOBS) -p $(BUILD)/lint -extra-arg=-Werror -extra-arg=-UNDEBUG \
    -extra-arg=-include -extra-arg=$(CURDIR)/cmake/lint.h
lint: format
	@$(call configure,release)
	@mkdir -p $(BUILD)/lint
	@sed 's/-fno-loop-unroll-and-jam//' $(BUILD)/compile_commands.json \
	    > $(BUILD)/lint/compile_commands.json
	@grep -qE '"file": ".*/($(DEEP))/.+"' $(BUILD)/lint/compile_commands.json || \
	    { echo 'lint: there is no file in $(DEEP)' >&2; exit 1; }
	@$(TIDY) '^$(CURDIR)/($(DEEP))/.+$$'
	@$(if $(REST),$(TIDY) -checks='-clang-analyzer-*' $(REST:%='^$(CURDIR)/%/.+$$'))

# Beside lint's clang-tidy. Warnings of gcc and clang are errors in the builds that have presets.
.PHONY: check-static check-threads valgrind
check-static: deps-lint
	@cppcheck --quiet --enable=warning,performance,portability --inline-suppr --std=c17 \
	    -j $(JOBS) --error-exitcode=1 -I. --suppressions-list=cmake/cppcheck.txt \
	    core harness datasets baselines

# Fails below 99 % of core's branches or 94 % of harness's; OUT/coverage.html has them line by line.
# TESTS='test_mesh|test_lazy' runs these alone.
.PHONY: coverage
coverage: deps-test deps-coverage
	@$(call configure,coverage)
	@$(call compile,build-coverage) > /dev/null
	@tests/scripts/coverage.sh build-coverage $(JOBS) \
	    $(call out,coverage) '$(TESTS)'

# A seeded sample of each module; FILES='core/body/triangle*' looks at one file.
# An hour on two cores; below 85 % it fails.
COUNT ?= 120
FILES ?= *
.PHONY: mutation
mutation: build-tests
	@/usr/bin/python3 tests/scripts/mutate.py $(BUILD) \
	    $(call out,mutation) \
	    --files '$(FILES)' --count $(COUNT) --seed $(SEED) --jobs $(JOBS)

# ThreadSanitizer over what has threads: pools, scenes, several bodies, and all answers given by
# eight threads at once. That of gcc 12 does not start where the system spreads addresses widely.
THREADED = test_threads test_scene test_bodies test_scene_cells
check-threads: deps-test
	@$(call configure,tsan)
	@$(call compile,build-tsan,$(THREADED) answers) > /dev/null
	@fixed=; setarch -R true 2> /dev/null && fixed="setarch -R"; \
	for t in $(THREADED) "answers --threads 8 --check $(CURDIR)/tests/answers.txt"; do \
	    echo "== $$t"; \
	    (cd build-tsan/tests && TSAN_OPTIONS=halt_on_error=1 $$fixed ./$$t) || exit 1; done

# A smoke run: a mesh read in a child, a query on two files, every change of the metamorphic study.
VALGRIND = valgrind --quiet --error-exitcode=9 --leak-check=full --errors-for-leak-kinds=definite
valgrind: program-metamorphic deps-valgrind
	@$(VALGRIND) $(MOTE) mesh datasets/meshes/box.obj > /dev/null
	@$(VALGRIND) $(MOTE) distance datasets/meshes/box.obj datasets/meshes/flat-t.obj \
	    --method certified --method particle:n=8 --method particle-paper:n=5 > /dev/null
	@$(VALGRIND) $(BUILD)/tests/metamorphic --queries 200 > /dev/null

clean:
	rm -rf build build-asan build-debug build-tsan build-coverage build-fuzz build-perf-ab build-avx2

.PHONY: test-library test-stranger test-cluster test-exports install

test-library: deps
	@cmake/deps.sh cmake/packages-library.txt || echo "going on with the compilers at hand"
	@tests/scripts/core_only.sh

test-stranger: deps
	@tests/scripts/stranger.sh

test-cluster: build deps-cluster
	@tests/scripts/cluster.sh $(MOTE)

test-exports: build deps-exports
	@/usr/bin/python3 tests/scripts/exports.py $(MOTE) results/schema
	@/usr/bin/python3 tests/scripts/scenario_schema.py $(MOTE) datasets/scenario.schema.json datasets
	@$(call compile,$(BUILD),mote_shared)
	@PYTHONPATH=$(CURDIR)/$(BUILD)/python MOTE_NEED_MATPLOTLIB=1 /usr/bin/python3 tests/python/test_examples.py \
	    $(CURDIR)/tests/scripts/documented.sh $(CURDIR)/docs/python.md $(CURDIR)/$(MOTE)

# What libmote promises, as the headers are now (docs/compatibility.md).
.PHONY: interface-accept check-abi
interface-accept: build
	@$(call compile,$(BUILD),mote_shared)
	@/usr/bin/python3 tests/scripts/interface.py $(BUILD) accept

check-abi: deps deps-abi
	@tests/scripts/abidiff.sh $(call quoted,$(BASE))

# Under either name.
PREFIX ?= /usr/local
prefix ?= $(PREFIX)

install: build
	@$(call compile,$(BUILD),mote_static mote_shared manual)
	@cmake/install.sh $(BUILD) $(call quoted,$(prefix))

# Packages of an older build would be taken for those of this one.
.PHONY: deb test-deb
deb: build deps-deb page
	@$(call configure,release)
	@$(call compile,$(BUILD),mote_static mote_shared manual)
	@rm -rf $(BUILD)/deb
	@cd $(BUILD) && cpack > cpack.log 2>&1 || { cat cpack.log; exit 1; }
	@rm -rf $(BUILD)/deb/_CPack_Packages
	@ls $(BUILD)/deb/*.deb

test-deb: deb
	@cmake/deps.sh cmake/packages-bare.txt cmake/packages-lintian.txt
	@tests/scripts/deb.sh $(BUILD)/deb

.PHONY: uninstall
uninstall:
	@cmake/uninstall.sh $(call quoted,$(prefix))
