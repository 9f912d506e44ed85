#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""headers.py SOURCE: core/ and plugins/ ask nothing of an operating system.

A header in angle brackets is one of the C++ standard or of a library in the lists below. A header of a processor or of
a compiler is asked for within #if only. No function of POSIX is called by name, and no file of Linux is named. What
needs them belongs in platform/, behind a header of core/. A test may try a file of Linux where there is one.
"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "style"))
from sources import code_only, tracked  # noqa: E402

STANDARD = set("""
    algorithm any array atomic barrier bit bitset charconv chrono codecvt compare complex concepts condition_variable
    coroutine deque exception execution filesystem format forward_list fstream functional future initializer_list
    iomanip ios iosfwd iostream istream iterator latch limits list locale map memory memory_resource mutex new numbers
    numeric optional ostream queue random ranges ratio regex scoped_allocator semaphore set shared_mutex
    source_location span sstream stack stdexcept stop_token streambuf string string_view syncstream system_error thread
    tuple type_traits typeindex typeinfo unordered_map unordered_set utility valarray variant vector version
    cassert cctype cerrno cfenv cfloat cinttypes climits clocale cmath csetjmp csignal cstdarg cstddef cstdint cstdio
    cstdlib cstring ctime cuchar cwchar cwctype""".split())
LIBRARIES = re.compile(r"""(Eigen|fmt|spdlog|nlohmann|gtest|assimp|urdf_world|urdf_parser|urdf_model|console_bridge
    |insula_lcm|lcm|fast_float|CL)/ | (cholmod|expat|zlib|zstd)\.h$""", re.X)
# Of a processor or of a compiler: only where #if says that it is there.
CONDITIONAL = {"immintrin.h", "xmmintrin.h", "cpuid.h", "sanitizer/lsan_interface.h"}
POSIX = """
    fork execv execvp posix_spawn waitpid kill getpid getppid gettid setpgid pipe pipe2 dup2 fcntl poll
    epoll_wait socket setsockopt mmap munmap mkstemp setenv unsetenv isatty fileno fdopen popen pclose
    localtime_r gmtime_r timegm strerror_r strsignal readlink realpath usleep nanosleep clock_gettime sysconf
    syscall prctl setpriority sigaction sigprocmask pthread_self pthread_kill pthread_setname_np
    sched_setscheduler sched_setaffinity dlopen dlsym dlclose ftruncate fsync geteuid getuid""".split()
# A member of that name is called on an object, and one of a namespace by its name.
CALL = re.compile(r"(?<![\w.>:])(?:::)?(%s)\s*\(" % "|".join(POSIX))
DECLARED = re.compile(r"[\w>&*]\s+[&*]?$")  # "std::string realpath(": a function of that name is declared
TYPE = re.compile(r"\b(pid_t|ssize_t|mode_t|uid_t|sigset_t|pthread_t)\b")
LINUX_FILE = re.compile(r'"/(proc|sys|dev)/')
INCLUDE = re.compile(r"^\s*#\s*include\s*<([^>]+)>")


def header_fault(header, within_if):
    if header in STANDARD or LIBRARIES.match(header):
        return None
    if header in CONDITIONAL:
        return None if within_if else "<%s> is asked for only within #if" % header
    return "<%s> is no header of the C++ standard nor of a library of core/ and plugins/" % header


def faults(text, of_test=False):
    """(line, fault) of one source."""
    depth = 0
    for number, (line, code) in enumerate(zip(text.split("\n"), code_only(text).split("\n")), 1):
        word = re.match(r"\s*#\s*(if|endif)", line)
        if word:
            depth += 1 if word[1] == "if" else -1
        found = INCLUDE.match(line)
        fault = found and header_fault(found[1], depth > 0)
        if fault:
            yield number, fault
        for call in CALL.finditer(code):
            before = code[:call.start()]
            if not DECLARED.search(before) or before.rstrip().endswith("return"):
                yield number, "%s() is a function of POSIX" % call[1]
        if TYPE.search(code):
            yield number, "%s is a type of POSIX" % TYPE.search(code)[1]
        if not of_test and LINUX_FILE.search(line) and not line.lstrip().startswith("//"):
            yield number, "names a file of Linux"


def main(source):
    root = pathlib.Path(source).resolve()
    wrong, count = [], 0
    for path in tracked(root, ".h", ".cpp"):
        name = path.relative_to(root).as_posix()
        if name.startswith(("core/", "plugins/")):
            count += 1
            found = faults(path.read_text(encoding="utf-8"), name.endswith("_test.cpp"))
            wrong += ["%s:%d: %s" % (name, number, fault) for number, fault in found]
    print("\n".join(wrong) or "%d files ask nothing of an operating system" % count)
    if wrong:
        print("What needs the operating system belongs in platform/, behind a header of core/ (docs/distribution.md).")
    return 1 if wrong or count == 0 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
