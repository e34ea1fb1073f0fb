// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/script.hh"

#include <dlfcn.h>
#include <unistd.h>

#include <fmt/format.h>

#include "hal/script/session.hh"

namespace mw::hal::script {

namespace {

constexpr const char *LIBRARY = "libmillwright_haltcl.so";

/// Folders with the shared part: ../lib/tcl in a build folder, the library folder when installed.
std::vector<std::string> places() {
    const std::string bin = program_folder();
    std::vector<std::string> places;
    for (const char *folder : {"/../lib/tcl/", "/../" MW_LIBDIR "/millwright/tcl/"}) {
        places.push_back(bin + folder + LIBRARY);
    }
    return places;
}

}  // namespace

std::size_t session_layout() {
    return sizeof(Session) * 65536 + sizeof(SessionOptions);
}

Result<std::unique_ptr<ScriptRunner>> load_tcl(Session &session) {
    std::string why = "it is not installed";
    for (const std::string &path : places()) {
        if (access(path.c_str(), R_OK) != 0) {
            continue;
        }
        // Never unloaded: Tcl keeps state until the process ends. Global, because Tcl extensions need its
        // symbols.
        void *library = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
        if (library == nullptr) {
            why = dlerror();
            continue;
        }
        const auto make = reinterpret_cast<NewScriptRunner>(dlsym(library, NEW_SCRIPT_RUNNER));
        ScriptRunner *runner = make == nullptr ? nullptr : make(&session, session_layout());
        if (runner != nullptr) {
            return std::unique_ptr<ScriptRunner>(runner);
        }
        why = "it belongs to another version";
    }
    return fail(fmt::format("Tcl files need {}: {}", LIBRARY, why), {},
                "install Tcl 8.6, and this program with its Tcl part");
}

}  // namespace mw::hal::script
