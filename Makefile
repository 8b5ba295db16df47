# dem.h itself needs no build. `make run` runs the tumbling mill, `make test` the tests, `make help` lists all targets.
# GNU make. It writes everything into build/.

# ---- variables that you may set: make CC=clang, make CFLAGS=-O1, make OMP= (no threads), make JOBS=1 ----
CC           ?= cc
CFLAGS       ?= $(CFLAGS_FOUND)
OMP          ?= $(OMP_FOUND)
LDLIBS       ?= -lm
PYTHON       ?= /usr/bin/python3
FUZZ_CC      ?= clang
FUZZ_SECONDS ?= 600
MPICC        ?= mpicc
MPIRUN       ?= mpirun --oversubscribe $(if $(filter 0,$(shell id -u)),--allow-run-as-root)
FILTER       ?=
LAW          ?=
NAME         ?=
PREFIX       ?= /usr/local
DESTDIR      ?=
JOBS         ?= $(shell getconf _NPROCESSORS_ONLN 2>/dev/null || echo 1)

# ---- lists of sources and programs ----
ROOMS    := src/dem.h $(wildcard src/*/*.h)
FOLDERS  := $(filter-out api,$(shell sed -n 's/^\#include "\([a-z]*\)\/.*/\1/p' src/dem.h | uniq))
HARD     := $(patsubst tests/hard/%.c,build/%,$(wildcard tests/hard/hard_*.c))
TEST_C   := $(wildcard tests/*/test_*.c)
TESTS    := $(patsubst %.c,build/%,$(notdir $(TEST_C))) $(HARD)
LESSONS  := $(patsubst examples/%.c,build/%,$(wildcard examples/[0-9][0-9]_*.c))
# examples of shipped laws, machines and files: they run without options and check themselves
SHOWS    := $(addprefix build/,wet_sand heat rock hopper mixer belt screen)
STUDIES  := $(filter-out $(LESSONS) $(SHOWS),$(patsubst examples/%.c,build/%,$(wildcard examples/*.c)))
FUZZERS  := $(patsubst tests/%.c,build/%,$(wildcard tests/fuzz_*.c))
BENCHES  := $(patsubst bench/%.c,build/%,$(wildcard bench/*.c))
BENCH_ALSO := $(if $(wildcard bench/bench.c),build/bench_single build/bench_O2)
ACCURACY_ALSO := $(if $(wildcard bench/accuracy.c),build/accuracy_single build/accuracy_one_domain)

hash := \#
HAVE_PYTHON := $(if $(filter python-check,$(MAKECMDGOALS)),$(shell command -v $(PYTHON)))

# ---- options that the compiler knows; tested only if something is to be compiled ----
ifneq ($(filter-out help new clean tags english pages-check rooms recipes upgrade-check viewer web check coverage fuzz docs options python site,$(or $(MAKECMDGOALS),help)),)
$(shell mkdir -p build/tmp build/rooms build/obj)
CFLAGS_FOUND := $(shell echo 'int main(void) { return 0; }' > build/probe.c; \
    for f in -std=c99 -O3 -march=native -fno-math-errno -ffp-contract=off; do \
        $(CC) $$f build/probe.c -o build/probe >build/probe.log 2>&1 && test ! -s build/probe.log && echo $$f; done)
ifeq ($(origin OMP),file)
OMP_FOUND := $(shell printf '%s\n' '$(hash)include <omp.h>' 'int main(void) { return omp_get_max_threads() < 1; }' \
        > build/probe.c; for f in "-fopenmp" "-Xpreprocessor -fopenmp -lomp"; do \
        $(CC) build/probe.c -o build/probe $$f >build/probe.log 2>&1 && echo "$$f" && break; done)
$(if $(OMP_FOUND),,$(info OpenMP not found: running on one thread))
endif
# somebody waits for `make run`: -O2 compiles in two thirds of the time of -O3, and with -flto all cores share the
# work when the program is linked; the bits are the same
ifeq ($(MAKECMDGOALS),run)
LTO := $(shell f=-flto=$(JOBS); echo 'int main(void) { return 0; }' > build/probe.c; \
    $(CC) $(CFLAGS) $$f build/probe.c -o build/probe >build/probe.log 2>&1 && test ! -s build/probe.log && echo $$f)
endif
COMPILE = $(CC) $(CFLAGS) $(CPPFLAGS) -I.
LINK = $(OMP) $(LDFLAGS) $(LDLIBS)
# build/flags changes with the compiler and its flags; then everything is built again
$(shell echo '$(COMPILE) $(LINK)' | cmp -s - build/flags || echo '$(COMPILE) $(LINK)' > build/flags)
MAKEFLAGS += -j$(JOBS)
endif

.PHONY: help help-all all run new install python python-check rooms test hard coverage mutants relations relations-sanitized law verdicts marks lessons web site examples shows studies studies-check mpi check bench bench-compile bench-instructions bench-parallel bench-peers peers-check bench-pages pages pages-check fuzz docs readers viewer browser tags english options pages-check recipes snippets upgrade-check clean
.DEFAULT_GOAL := help

# a target with `## TEXT` is in both lists, one with `### TEXT` in the long one; the short list ends TEXT at `;` or `:`
help: ## list the targets of every day; `make help-all` lists every target, with what each can be told
	@awk '/^[a-z-]+:.* ## / { target = $$1; sub(/.* ## /, ""); sub(/[;:] .*/, ""); printf "  make %-10s %s\n", \
	    substr(target, 1, length(target) - 1), $$0 } END { print "  make help-all   list every target, with options" }' Makefile
help-all:
	@awk '/^[a-z-]+:.* ###? / { target = $$1; sub(/.* ###? /, ""); printf "  make %s\n      %s\n", \
	    substr(target, 1, length(target) - 1), $$0 }' Makefile | fold -s -w 100

run: build/mill_first ## run a tumbling mill of coarse beads: a replay for the browser, pictures and figures in build/out/mill
	@mkdir -p build/out/mill
	GOMP_SPINCOUNT=1000 build/mill_first --first --replay --out build/out/mill

new: ## write a small program with comments to my.c; NAME=my: its first lines show how to build it
	@test -n "$(NAME)" || { echo "make new NAME=my: give the program a name"; exit 1; }
	@test ! -e "$(NAME).c" || { echo "make new: $(NAME).c is there already; give another NAME"; exit 1; }
	@sed 's#NAME#$(notdir $(NAME))#g' examples/new/program.c > "$(NAME).c"
	@echo "$(NAME).c: its first lines say how to build it"

install: ## copy dem.h, a library of dem.c, and files for pkg-config and CMake into PREFIX (/usr/local)
	@sh tests/install.sh "$(DESTDIR)$(PREFIX)" "$(PREFIX)" "$(CC)" "$(OMP)"

dem.h: $(ROOMS) src/join.awk ## join the files in src/ to dem.h, in the order of src/dem.h, if they compile
	@mkdir -p build
	@! command -v $(CC) >/dev/null || $(CC) $(CPPFLAGS) -DDEM_IMPLEMENTATION -fsyntax-only -c -o build/joined.o -x c src/dem.h
	@awk -f src/join.awk src/dem.h > build/joined.h
	@cmp -s build/joined.h $@ || { test ! -f $@ || cp $@ build/dem_before.h; cp build/joined.h $@; \
	    echo "dem.h: joined from src/ (what it was is in build/dem_before.h)"; }; touch $@

rooms: ## copy a change that was made in dem.h itself into the files in src/
	@awk -v to=src -f src/split.awk src/dem.h dem.h

test: $(TESTS) ## build and run all tests; FILTER=words: only those whose names contain the words; OF=contact: only those in tests/contact
	@JOBS=$(JOBS) sh tests/run.sh "$(FILTER)" $(if $(OF),$(patsubst %.c,build/%,$(notdir $(wildcard tests/$(OF)/*.c))),$(TESTS))

hard: $(HARD) build/test_facets build/test_sieve build/test_bonds ### run the hard cases in their long form, over an hour, and count cases and impacts; FILTER=words as in test
	@JOBS=$(JOBS) TEST_LONG=1 sh tests/run.sh "$(FILTER)" $^ > build/hard.log; code=$$?; cat build/hard.log; awk -f tests/hard/totals.awk build/hard.log; exit $$code

coverage: ### count lines and branches of src/ that the tests execute, by gcov; OF=core, FILTER=words as in test; PROGRAMS=test_maths: only these; PROGRAMS=relations: only N (400) scenes of relations
	@FILTER="$(FILTER)" OF="$(OF)" PROGRAMS="$(PROGRAMS)" N=$(N) JOBS=$(JOBS) sh tests/coverage.sh

mutants: ### N=200 SEED=1: make small errors in src/, one after another, and list those that no test notices; OF=core, PROGRAMS=... as in coverage
	@N="$(N)" SEED="$(SEED)" OF="$(OF)" PROGRAMS="$(PROGRAMS)" JOBS=$(if $(filter file,$(origin JOBS)),1,$(JOBS)) \
	    CC="$(CC)" CFLAGS="$(CFLAGS)" OMP="$(OMP)" sh tests/mutants.sh

relations: build/relations $(if $(SEED),,build/relations_float) ## draw N (400) scenes from rows of features and check relations between runs; SEED=97: all relations of one scene; N=100000: continues where it was interrupted
	@mkdir -p build/tmp build/out
	@if [ "$(SEED)" ]; then build/relations --seed $(SEED) --print; else \
	    jobs=$$(seq $(JOBS)); logs=; export OMP_WAIT_POLICY=passive; \
	    for job in $$jobs; do \
	        log=build/relations_$(or $(N),400)_$${job}_of_$(JOBS).log; logs="$$logs --add $$log"; $(if $(N),,rm -f $$log;) \
	        build/relations --scenes $(or $(N),400) --share $$job/$(JOBS) --log $$log & done; wait; \
	    build/relations $$logs --page build/out/relations.md; code=$$?; \
	    echo "single precision:"; build/relations_float --scenes 50 && exit $$code; fi

relations-sanitized: ### the same with sanitizers of addresses and undefined behaviour; N (1000) scenes, 140 s of processor time per 1000
	@mkdir -p build/san build/tmp
	@$(MAKE) --no-print-directory build/san/relations
	build/san/relations --scenes $(or $(N),1000)

law: $(if $(LAW),build/dem.o,build/exam) ## examine a contact law and draw its curves on a page; LAW=path/to/my_law.h: that law; without LAW the built-in laws
	@mkdir -p build/out/exam
	@if [ -n "$(LAW)" ]; then $(COMPILE) -DLAW_FILE='"$(abspath $(LAW))"' examples/exam.c build/dem.o -o build/law $(LINK) && build/law; \
	    else build/exam; fi

verdicts: build/dem.o build/01_bounce ### laws as students write them, and the verdict of the exam on each
	@CC="$(CC)" LINK="$(LINK)" sh tests/verdicts.sh build/dem.o

marks: build/dem.o $(if $(wildcard $(DIR)/answers.txt),$(LESSONS)) ### examine the laws and answers of a class: make marks DIR=folder writes folder/marks.csv; SEEDS=1: answers.txt has answers to the exercises that build/05_silo --seed NAME prints
	@CC="$(CC)" LINK="$(LINK)" SEEDS=$(SEEDS) sh examples/marks.sh "$(DIR)" build/dem.o

lessons: $(LESSONS) ## build and run the twelve lessons, record replays in build/out/NAME, check their marks
	@JOBS=$(JOBS) sh tests/lessons.sh $(LESSONS)

examples: lessons shows snippets ## run the lessons, the other examples that check themselves, and the programs in the manual and the pages
	@(cd build/out/hopper && cp hopper.csv whole.csv && ../../hopper --resume > resumed.txt && cmp hopper.csv whole.csv) || { echo "examples failed: resumed"; exit 1; }
	@echo "all examples as expected"

shows: $(SHOWS) ### run the other examples that check themselves; SHOWS=build/belt: only these
	@failed=; for e in $(SHOWS); do n=$$(basename $$e); echo "== $$n"; rm -rf build/out/$$n; mkdir -p build/out/$$n; cp examples/data/*.stl build/out/$$n; \
	    (cd build/out/$$n && ../../$$n) || failed="$$failed $$n"; done; \
	if test -n "$$failed"; then echo "examples failed:$$failed"; exit 1; fi

studies: $(STUDIES) ## build the studies into build/; each has an option --help

studies-check: build/mill build/screener build/ellipsoids build/separator build/shear build/triaxial ### run every command of the four studies and of two tests of materials in README.md and docs/ in a short form; LONG=1: as written, in two hours
	@JOBS=$(JOBS) sh tests/studies.sh $(if $(LONG),long)

mpi: build/dem.o ### build the programs in examples/mpi and run them on 1, 2 and 3 processes, if mpicc is installed
	@printf '%s\n' '$(hash)include <mpi.h>' 'int main(void) { return MPI_Finalize(); }' > build/probe.c; \
	if ! command -v $(MPICC) >/dev/null; then \
	    echo "SKIP: $(MPICC) not found (Debian package libopenmpi-dev)"; \
	elif ! $(MPICC) build/probe.c -o build/probe >build/probe.log 2>&1; then \
	    echo "SKIP: $(MPICC) lacks mpi.h or its library (Debian package libopenmpi-dev)"; \
	else set -e; echo "$(MPICC) $(CFLAGS) -O2 $(CPPFLAGS) -I. -o build/mpi_slabs examples/mpi/slabs.c build/dem.o $(LINK)"; \
	    $(MPICC) $(CFLAGS) -O2 $(CPPFLAGS) -I. -o build/mpi_slabs examples/mpi/slabs.c build/dem.o $(LINK); \
	    for n in 1 2 3; do echo "== $$n"; $(MPIRUN) -n $$n build/mpi_slabs; done; \
	    $(MPICC) $(CFLAGS) -O2 $(CPPFLAGS) -I. -o build/mill_mpi examples/mpi/mill.c build/dem.o $(LINK); \
	    for n in 1 2; do echo "== mill in 2 slabs, processes: $$n"; $(MPIRUN) -n $$n build/mill_mpi --slabs 2 --quick \
	        --diameter 0.07 --settle 0.1 --revolutions 0.05 --frames 0 --out build/out/mill_mpi_$$n > build/mill_mpi.$$n; \
	        grep '^hash' build/mill_mpi.$$n; done; cmp build/out/mill_mpi_1/grains.svg build/out/mill_mpi_2/grains.svg; \
	    test "$$(grep '^hash' build/mill_mpi.1)" = "$$(grep '^hash' build/mill_mpi.2)"; fi

all: $(STUDIES) $(LESSONS) $(SHOWS) $(TESTS) $(BENCHES) $(BENCH_ALSO) $(ACCURACY_ALSO) ### build everything, run nothing

check: ## test with all compilers, standards, precisions, warnings and sanitizers found, over an hour; report what was skipped
	@JOBS=$(JOBS) sh tests/check.sh

# each thread stays on its own core
BIND := OMP_PROC_BIND=true OMP_PLACES=cores
bench: $(BENCHES) $(BENCH_ALSO) ## run all benches in their quick form, in under 3 minutes; each has an option --help
	@$(BIND) build/bench && build/bench_single --brief && build/bench_O2 --brief --scene bed && \
	    $(BIND) build/parallel --short --threads 2 --settle 0 && STEPS=60 ROUNDS=3 CORES=1 SCENES="bed drum gas" sh bench/peers.sh

bench-compile: build/flags ### measure the processor time of compiling dem.h, for each compiler and level
	@sh bench/compile.sh

bench-effects: build/bench ### measure the cost of each effect, present and absent
	@build/bench --scene effects --threads 1

bench-instructions: ### count the instructions of each part of dem.h per body and step, by valgrind
	@sh bench/instructions.sh

bench-parallel: build/parallel ### measure threads, sizes and searches beside published figures, in minutes
	@$(BIND) build/parallel

bench-peers: $(BENCHES) $(BENCH_ALSO) ### run the same scenes in dem.h and in LAMMPS, LIGGGHTS, YADE, Bullet and ODE, as far as they are installed
	@sh bench/peers.sh && sh bench/rigid.sh

peers-check: build/bench build/blocks build/beside build/rigid ### run bench-peers in a short form: small scenes, one round, all codes that are installed
	@SHORT=1 sh bench/peers.sh && SHORT=1 sh bench/rigid.sh

bench-pages: $(BENCHES) $(BENCH_ALSO) $(ACCURACY_ALSO) build/screener build/ellipsoids ### measure the speeds in docs/ again and write them; PAGES=roofline: one page
	@sh bench/pages.sh $(PAGES)

# figures that need no quiet machine: a busy one gives the same bits
pages: $(LESSONS) build/readme_program ### write the figures that lessons and the README's program print into the pages
	@JOBS=$(JOBS) sh bench/pages.sh lessons heap

pages-check: ### list the measured figures in README.md and docs/ that are older than their code; STRICT=1: fail if there are any
	@STRICT=$(STRICT) sh tests/pages.sh

fuzz: ### run clang's fuzzer with sanitizers on each file reader and on random calls, FUZZ_SECONDS (600) each
	@FUZZ_CC="$(FUZZ_CC)" FUZZ_SECONDS="$(FUZZ_SECONDS)" sh tests/fuzz.sh

docs: ### check that the links in README and docs lead somewhere, and that cited keys exist
	@awk -f tests/links.awk README.md CHANGELOG.md CONTRIBUTING.md docs/*.md

readers: build/write_files ### write every file format and open it with VTK and ASE
	@mkdir -p build/out/readers && cd build/out/readers && ../../write_files
	@$(PYTHON) tests/read_vtk.py build/out/readers
	@$(PYTHON) tests/read_xyz.py build/out/readers

tags: ### check that dem.h is joined from src/, that its parts agree with its contents, that parts, functions and lines keep their limits, that volume I names nothing of volume II, that few fields have many writers, that few lines name a feature outside its files, that calls of user-defined functions are marked, and that relations call every public function
	@awk -f src/join.awk src/dem.h | cmp - dem.h
	@awk -f tests/tags.awk dem.h
	@awk -f tests/plain.awk -f tests/storeys.awk src/dem.h
	@awk -f tests/plain.awk -f tests/writers.awk src/dem.h
	@awk -f tests/plain.awk -f tests/features.awk src/dem.h
	@awk -f tests/calls.awk dem.h
	@awk -f tests/relations/called.awk dem.h tests/relations/*.h tests/relations/relations.c
	@awk -f tests/relations/fields.awk tests/relations/fields.txt dem.h tests/relations/calls.h
	@$(MAKE) --no-print-directory english

english: ### list sentences of pages, public comments, error messages and test names that need a second reading
	@awk -f tests/english.awk README.md CHANGELOG.md CONTRIBUTING.md docs/*.md dem.h examples/*.c examples/*.h examples/laws/*.h tests/*.c tests/*/*.c

options: dem.h ### write docs/options.md and docs/options_run.md, every field of every desc, from dem.h
	@mkdir -p build && $(CC) -std=c99 -DDEM_STATIC -DDEM_NO_OPENMP -I. tests/options.c -o build/options $(LDLIBS) && build/options > build/options.txt
	@awk -f tests/options.awk - dem.h < build/options.txt > build/options.md && cp build/options.md docs/options.md
	@awk -v part=run -f tests/options.awk - dem.h < build/options.txt > build/options.md && cp build/options.md docs/options_run.md

python: dem.h ## write examples/python/dem.py and dem.pyi from dem.h and examples/python/base.py
	@mkdir -p build && $(PYTHON) examples/python/make.py > build/dem.py && cp build/dem.py examples/python/dem.py
	@$(PYTHON) examples/python/make.py --stubs > build/dem.pyi && cp build/dem.pyi examples/python/dem.pyi

python-check: $(if $(HAVE_PYTHON),$(LESSONS)) ### test examples/python: dem.py is that of dem.h, layouts of structs, errors, functions, lessons; LONG=1: whole lessons
	@if [ -z "$(HAVE_PYTHON)" ]; then echo "SKIP: $(PYTHON) not found (Debian package python3): examples/python is not tested"; \
	    else CC="$(CC)" JOBS=$(JOBS) LONG=$(LONG) DEM_CFLAGS="$(if $(filter file,$(origin CFLAGS)),-O1,$(CFLAGS))" $(PYTHON) tests/python/check.py "$(FILTER)"; fi

web: ### build the browser lesson and the law lab (dem.h in WebAssembly) into examples/web/pages, and both as programs
	@sh examples/web/make.sh build/web && mkdir -p examples/web/pages && cp build/web/lesson.html build/web/lab.html examples/web/pages

site: ### write the documentation as a static site into build/site: search, reference, gallery; check its links and docs/find.md
	@sh tests/find.sh
	@command -v $(PYTHON) >/dev/null || { echo "SKIP: $(PYTHON) not found (Debian packages python3-sphinx, python3-myst-parser, furo)"; exit; }; $(PYTHON) docs/site/build.py build/site

viewer: ### copy examples/replay/viewer.html into src/replay/viewer.h
	@mkdir -p build && awk -f tests/viewer.awk examples/replay/viewer.html src/replay/viewer.h > build/viewer.h && cp build/viewer.h src/replay/viewer.h

browser: build/write_replays ### play replays in a headless chromium: frames, pixels, no errors
	@sh tests/browser.sh

recipes: ### apply the patches of docs/extending*.md to a copy of dem.h and use the result
	@CC="$(CC)" sh tests/recipes.sh

upgrade-check: ### test examples/upgrade.sh: tables against the public names, programs of users; LONG=1: and their results
	@CC="$(CC)" sh tests/upgrade.sh $(if $(LONG),long)

snippets: build/dem.o ### compile the programs in dem.h's manual and in the pages; run those of docs/how_to*.md and compare what they print
	@rm -rf build/snippets && mkdir -p build/snippets
	@awk -v out=build/snippets -f tests/snippets.awk dem.h README.md CONTRIBUTING.md docs/extending.md docs/laws.md docs/replay.md \
	    docs/own_law.md docs/parallel.md docs/impulses.md docs/shapes.md docs/how_to.md docs/how_to_shapes.md docs/how_to_more.md
	@JOBS=$(JOBS) COMPILE="$(COMPILE)" LINK="$(LINK)" sh tests/snippets.sh

clean: ## remove build/
	rm -rf build

# ---- how a program is built: programs with dem.c, which is compiled once; benches, which look inside, with dem.h in
# them; tests with the rooms of dem.h as separate objects, all of whose functions are visible (src/open.sh), so that
# after an edit only its folder is compiled again ----
# examples/*.h are companions of dem.h (moldyn.h, tumbler.h, ...), which tests and benches include, too
HEADERS := $(wildcard examples/*.h)
ROOMS_O := $(FOLDERS:%=build/rooms/%.o)
# -O3 takes three times as long to compile as -O2 and is for those that run long. Tests themselves, not the rooms that they
# test, are compiled with -O1
LEVEL    = $(if $(filter file,$(origin CFLAGS)),-O2)
build/rooms/made: $(ROOMS) src/open.awk src/open.sh
	@sh src/open.sh build/rooms && touch $@
build/rooms/private.h $(FOLDERS:%=build/rooms/%.c): build/rooms/made ;
$(ROOMS_O): build/rooms/%.o: build/rooms/%.c build/flags
	$(COMPILE) $(LEVEL) $(OMP) -c -o $@ $<
# some tests need several domains of few bodies
build/rooms/small_%.o: build/rooms/%.c build/flags
	$(COMPILE) $(LEVEL) $(OMP) -DDEM_DOMAIN_BODIES=16 -DDEM_THREADS_FIXED -c -o $@ $<
SMALL_O := $(patsubst %/search.o,%/small_search.o,$(patsubst %/file.o,%/small_file.o,$(ROOMS_O)))
# a call of every public function, each argument bad in turn: made anew when dem.h is another
tests/refused.h: tests/refused.awk dem.h
	awk -f tests/refused.awk dem.h > $@
build/obj/test_refused.o: tests/refused.h
build/obj/test_naive.o: $(wildcard tests/relations/naive.*)
build/obj/test_shrink.o: $(wildcard tests/relations/*.h)
OPEN = -include build/rooms/private.h
build/obj/test_own_law.o: OPEN =# compiles a law into dem.h
define TEST
build/obj/$(2).o: $(1) $(wildcard tests/*.h) $(HEADERS) build/rooms/private.h build/flags
	$$(COMPILE) $$(LEVEL:-O2=-O1) $$(OMP) $$(OPEN) -c -o $$@ $(1)
build/$(2): build/obj/$(2).o $(if $(filter test_own_law,$(2)),,$(if $(filter test_api test_feed test_members,$(2)),$(SMALL_O),$(ROOMS_O)))
	$$(CC) -o $$@ $$^ $$(LINK)
endef
$(foreach t,$(TEST_C) $(wildcard tests/hard/hard_*.c),$(eval $(call TEST,$(t),$(basename $(notdir $(t))))))
$(LESSONS) $(SHOWS) $(STUDIES): build/%: examples/%.c $(HEADERS)
$(BENCHES): build/%: bench/%.c $(HEADERS) $(wildcard bench/*.h)
build/parallel: examples/mill.c
build/write_files: tests/write_files.c
build/write_replays: tests/write_replays.c
$(BENCHES): dem.h build/flags
	$(COMPILE) -o $@ $(filter %/$(@F).c,$^) $(LINK)
# relations have work groups of any size and use all threads that a scene asks for; once more in single precision
RELATIONS = $(COMPILE) $(OMP) -include tests/relations/groups.h -DDEM_THREADS_FIXED
build/relations_float build/obj/relations_float_dem.o: OTHER = -DDEM_REAL=float
build/obj/relations_dem.o build/obj/relations_float_dem.o: dem.c dem.h tests/relations/groups.h build/flags
	$(RELATIONS) $(LEVEL) $(OTHER) -c -o $@ $<
build/relations build/relations_float: build/%: tests/relations/relations.c $(wildcard tests/relations/*.h examples/laws/*.h) build/obj/%_dem.o
	$(RELATIONS) $(LEVEL:-O2=-O1) $(OTHER) -o $@ $< build/obj/$*_dem.o $(LINK)
SANITIZE = -g -O1 -ffp-contract=off -fsanitize=address,undefined -fno-sanitize-recover=all
build/san/dem.o: dem.c dem.h tests/relations/groups.h
	@mkdir -p $(@D)
	$(CC) -std=c99 $(SANITIZE) -I. $(OMP) -include tests/relations/groups.h -DDEM_THREADS_FIXED -c -o $@ dem.c
build/san/relations: tests/relations/relations.c $(wildcard tests/relations/*.h examples/laws/*.h) build/san/dem.o
	$(CC) -std=c99 $(SANITIZE) -I. -o $@ $< build/san/dem.o $(LINK)
build/dem.o: dem.c dem.h build/flags
	$(COMPILE) $(OMP) -c -o $@ dem.c
$(LESSONS) $(SHOWS) $(STUDIES) build/write_files build/write_replays: build/dem.o
	$(COMPILE) -o $@ $(filter %/$(@F).c,$^) build/dem.o $(LINK)
build/first/%.o: %.c dem.h $(HEADERS) build/flags
	@mkdir -p $(@D)
	$(COMPILE) $(LEVEL) $(LTO) $(OMP) -c -o $@ $<
build/mill_first: build/first/dem.o build/first/examples/mill.o
	$(COMPILE) $(LEVEL) $(LTO) -o $@ $^ $(LINK)
build/readme_program: README.md tests/snippets.awk build/dem.o
	@rm -rf build/readme && mkdir -p build/readme && awk -v out=build/readme -f tests/snippets.awk README.md
	sed '/DEM_IMPLEMENTATION/d' build/readme/README_md_1_program.c > build/readme/heap.c
	$(COMPILE) -o $@ build/readme/heap.c build/dem.o $(LINK)
# benches print how they were built; bench.c is also built in single precision and with plain -O2
$(BENCHES): private CPPFLAGS += -DBENCH_FLAGS='"$(strip $(CFLAGS) $(OMP))"'
build/bench_single: bench/bench.c $(HEADERS) $(wildcard bench/*.h) dem.h build/flags
	$(COMPILE) -DDEM_REAL=float -DBENCH_FLAGS='"$(strip $(CFLAGS) $(OMP)) -DDEM_REAL=float"' -o $@ $< $(LINK)
# the cost of single precision, and of equal bits for any number of threads: see bench/accuracy.c
build/accuracy_single: OTHER = -DDEM_REAL=float -DBENCH_VARIANT='"single"'
build/accuracy_one_domain: OTHER = -DDEM_DOMAIN_BODIES=100000000 -DBENCH_VARIANT='"one_domain"'
$(ACCURACY_ALSO): bench/accuracy.c $(HEADERS) $(wildcard bench/*.h) dem.h build/flags
	$(COMPILE) $(OTHER) -DBENCH_FLAGS='"$(strip $(CFLAGS) $(OMP))"' -o $@ $< $(LINK)
build/bench_O2: bench/bench.c $(HEADERS) $(wildcard bench/*.h) dem.h build/flags
	$(CC) -std=c99 -O2 $(CPPFLAGS) -I. -DBENCH_LABEL='".O2"' -DBENCH_FLAGS='"-std=c99 -O2 $(OMP)"' -o $@ $< $(LINK)
ifeq ($(wildcard examples/mill.c),)
build/mill:
	@echo "examples/mill.c is not there"; exit 1
endif
build/flags: ;
