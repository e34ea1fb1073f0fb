// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/own_place.hh"

#include <unistd.h>

#include <cstdlib>
#include <new>
#include <string_view>

namespace mw {

namespace {

/// Prepends `folder` to a list of folders in the environment unless it is first already.
void prepend(const char *variable, const std::string &folder, const char *fallback) {
    const char *set = std::getenv(variable);
    const std::string before = set != nullptr ? set : fallback;
    if (before == folder || before.starts_with(folder + ":")) {
        return;
    }
    ::setenv(variable, (before.empty() ? folder : folder + ":" + before).c_str(), 1);
}

/// TCLLIBPATH is a Tcl list. Of several packages with the same name and version Tcl uses that of the first
/// folder.
void prepend_tcl(const std::string &folder) {
    const char *set = std::getenv("TCLLIBPATH");
    const std::string before = set != nullptr ? set : "", word = '{' + folder + '}';
    if (before == word || before.starts_with(word + ' ')) {
        return;
    }
    ::setenv("TCLLIBPATH", (before.empty() ? word : word + ' ' + before).c_str(), 1);
}

}  // namespace

std::string program_folder() {
    char path[4096];
    const ssize_t length = ::readlink("/proc/self/exe", path, sizeof path);
    const std::string_view program(path, length > 0 ? static_cast<std::size_t>(length) : 0);
    const std::size_t slash = program.rfind('/');
    return slash == std::string_view::npos ? "." : std::string(program.substr(0, slash));
}

void tell_when_memory_ends() noexcept {
    std::set_new_handler([] {
        constexpr char TEXT[] = "no memory left: more is needed than the system (or 'ulimit -v') gives\n";
        (void)!::write(STDERR_FILENO, TEXT, sizeof TEXT - 1);
        ::_exit(1);
    });
}

void offer_own_programs() {
    tell_when_memory_ends();
    const std::string here = program_folder();
    prepend("PATH", here, "/usr/local/bin:/usr/bin:/bin");
    // For the build folder and the installed program.
    for (const char *packages : {"/../lib/tcl", "/../lib/millwright/tcl"}) {
        if (::access((here + packages + "/pkgIndex.tcl").c_str(), R_OK) == 0) {
            prepend_tcl(here + packages);
            break;
        }
    }
    for (const char *modules : {"/../lib/python", "/../lib/millwright/python"}) {
        if (::access((here + modules + "/hal").c_str(), R_OK) == 0) {
            prepend("PYTHONPATH", here + modules, "");
            return;
        }
    }
}

}  // namespace mw
