#include "core/parts/parts_hacd.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <bullet/HACD/hacdHACD.h>

namespace mote_parts_detail
{
namespace
{

using Clock = std::chrono::steady_clock;
using Point = HACD::Vec3<HACD::Real>;
using Face = HACD::Vec3<long>;

/* What the child says of a component in place of the number of its parts. */
constexpr uint32_t FAILED = UINT32_MAX;
constexpr uint32_t NO_MEMORY = UINT32_MAX - 1;

/* A component as HACD wants it, and room for what the child says of it: {count, part of each
   face}. Made before the fork. */
struct Problem {
    explicit Problem(const Component &c) : said(1 + c.faces.size())
    {
        for (const mote_vec3 &p : c.points)
            points.emplace_back(p.x, p.y, p.z);
        for (const auto &f : c.faces)
            faces.emplace_back(long{f[0]}, long{f[1]}, long{f[2]});
    }
    void solve();

    std::vector<Point> points;
    std::vector<Face> faces;
    std::vector<uint32_t> said;
};

void Problem::solve()
{
    HACD::HACD hacd;
    hacd.SetPoints(points.data());
    hacd.SetNPoints(points.size());
    hacd.SetTriangles(faces.data());
    hacd.SetNTriangles(faces.size());
    hacd.SetNClusters(1);
    hacd.SetConcavity(100);
    hacd.SetCompacityWeight(0.1);
    hacd.SetVolumeWeight(0);
    hacd.SetAddExtraDistPoints(true);
    hacd.SetAddFacesPoints(true);
    hacd.SetNVerticesPerCH(100);
    said[0] = FAILED;
    if (!hacd.Compute())
        return;
    const long *partition = hacd.GetPartition();
    for (size_t f = 0; f < faces.size(); ++f)
        said[1 + f] = static_cast<uint32_t>(partition[f]);
    said[0] = static_cast<uint32_t>(hacd.GetNClusters());
}

/* In the child: nothing that the caller set up may run or write here. */
void become_quiet(double seconds)
{
    for (int number = 1; number < NSIG; ++number)
        (void)signal(number, SIG_DFL);
    sigset_t none;
    (void)sigemptyset(&none);
    (void)sigprocmask(SIG_SETMASK, &none, nullptr);
#ifdef __linux__
    (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
    const rlimit no_core = {0, 0};
    (void)setrlimit(RLIMIT_CORE, &no_core);
    itimerval limit = {};
    limit.it_value.tv_sec = static_cast<time_t>(seconds);
    limit.it_value.tv_usec =
        std::max(1L, static_cast<long>(1e6 * (seconds - std::floor(seconds))));
    (void)setitimer(ITIMER_PROF, &limit, nullptr);
}

bool write_all(int file, const void *bytes, size_t size)
{
    const char *from = static_cast<const char *>(bytes);
    while (size > 0) {
        const ssize_t written = write(file, from, size);
        if (written <= 0)
            return false;
        from += written;
        size -= static_cast<size_t>(written);
    }
    return true;
}

/* The child's whole life: it says of each problem, in turn, what HACD makes of it. */
[[noreturn]] void work(std::vector<Problem> &problems, size_t first, int answers,
                       double seconds)
{
    become_quiet(seconds);
    const int file = fcntl(answers, F_DUPFD, 3);
    for (int standard = 0; standard < 3; ++standard)
        (void)close(standard);
    for (size_t i = first; i < problems.size(); ++i) {
        Problem &problem = problems[i];
        try {
            problem.solve();
        } catch (const std::bad_alloc &) {
            problem.said[0] = NO_MEMORY;
        } catch (...) {
            problem.said[0] = FAILED;
        }
        if (!write_all(file, problem.said.data(), problem.said.size() * sizeof(uint32_t)))
            break;
    }
    _exit(0);
}

[[noreturn]] void fail(const char *what, int why)
{
    throw std::runtime_error(std::string(what) + ": " + std::generic_category().message(why));
}

/* A child and the pipe from it; both end with this. */
class Child
{
  public:
    Child(std::vector<Problem> &problems, size_t first, double seconds);
    ~Child();
    Child(const Child &) = delete;
    Child &operator=(const Child &) = delete;

    bool hear(std::vector<uint32_t> &said);
    double end();

  private:
    int answers = -1;
    pid_t process = -1;
    Clock::time_point deadline;
};

Child::Child(std::vector<Problem> &problems, size_t first, double seconds)
    : deadline(Clock::now() + std::chrono::milliseconds(static_cast<long>(1e4 * seconds)))
{
    int ends[2];
    if (pipe(ends) != 0)
        fail("no pipe to a process for HACD", errno);
    for (int end : ends)
        (void)fcntl(end, F_SETFD, FD_CLOEXEC);
    process = fork();
    if (process == 0) {
        (void)close(ends[0]);
        work(problems, first, ends[1], seconds);
    }
    const int why = errno;
    (void)close(ends[1]);
    answers = ends[0];
    if (process < 0) {
        (void)close(answers);
        fail("no process for HACD", why);
    }
}

/* Reads what the child says of the next problem; false if it says no more. */
bool Child::hear(std::vector<uint32_t> &said)
{
    char *to = reinterpret_cast<char *>(said.data());
    size_t left = said.size() * sizeof(uint32_t);
    while (left > 0) {
        const auto wait =
            std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now());
        pollfd ready = {answers, POLLIN, 0};
        const int events = poll(&ready, 1, std::max(0, static_cast<int>(wait.count())));
        if (events < 0 && errno == EINTR)
            continue;
        const ssize_t got = events > 0 ? read(answers, to, left) : 0;
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return false;
        to += got;
        left -= static_cast<size_t>(got);
    }
    return true;
}

/* Ends the child; returns how many seconds of the processor it took, infinity if that is not
   known because the caller has its children reaped by others, or if it was stopped. */
double Child::end()
{
    if (process < 0)
        return 0;
    (void)close(answers);
    (void)kill(process, SIGKILL);
    int status = 0;
    rusage used = {};
    pid_t reaped;
    while ((reaped = wait4(process, &status, 0, &used)) < 0 && errno == EINTR)
        continue;
    process = -1;
    const int signal = reaped > 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (reaped < 0 || signal == SIGPROF || signal == SIGKILL)
        return HUGE_VAL;
    return static_cast<double>(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * static_cast<double>(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

Child::~Child()
{
    (void)end();
}

/* HACD has always numbered its clusters so; if it did not, nothing may be written outside of
   arrays. */
bool is_valid(const std::vector<uint32_t> &said)
{
    return said[0] > 0 && std::all_of(said.begin() + 1, said.end(),
                                      [&said](uint32_t part) { return part < said[0]; });
}

} // namespace

void split_by_hacd(const std::vector<Component *> &components, double seconds)
{
    std::vector<Problem> problems;
    problems.reserve(components.size());
    for (const Component *component : components)
        problems.emplace_back(*component);
    for (size_t next = 0; next < problems.size() && seconds > 0;) {
        Child child(problems, next, seconds);
        while (next < problems.size() && child.hear(problems[next].said)) {
            const std::vector<uint32_t> &said = problems[next].said;
            if (said[0] == NO_MEMORY)
                throw std::bad_alloc();
            if (said[0] != FAILED && is_valid(said)) {
                components[next]->count = said[0];
                components[next]->part.assign(said.begin() + 1, said.end());
            }
            ++next;
        }
        seconds -= child.end();
        ++next; /* the one that it ended on */
    }
}

} // namespace mote_parts_detail
