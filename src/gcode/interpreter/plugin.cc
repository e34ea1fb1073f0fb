// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/plugin.hh"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "base/own_place.hh"

namespace mw::gcode {
namespace {

Result<PluginFactory> factory_in(const std::string &path) {
    constexpr char HINT[] =
        "a plug-in is compiled against gcode/interpreter/program_interpreter.hh of this version";
    // The library is never closed, because canon records may refer to its text, and its code must outlive its
    // objects.
    void *const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
        return fail(fmt::format("cannot load the interpreter {}: {}", path, ::dlerror()), {}, HINT);
    }
    const int *const version = static_cast<const int *>(::dlsym(library, PLUGIN_VERSION_SYMBOL));
    void *const factory = ::dlsym(library, PLUGIN_FACTORY_SYMBOL);
    if (version == nullptr || factory == nullptr || *version != PLUGIN_VERSION) {
        return fail(fmt::format("{} is not an interpreter for this version of Millwright", path), {}, HINT);
    }
    return reinterpret_cast<PluginFactory>(factory);
}

}  // namespace

Result<std::unique_ptr<ProgramInterpreter>> open_plugin(const std::string &name, const PluginParts &parts) {
    std::vector<std::string> candidates;
    if (name.starts_with('/')) {
        candidates.push_back(name);
    } else {
        if (const char *home = std::getenv("EMC2_HOME"); home != nullptr) {
            candidates.push_back(std::string(home) + "/lib/linuxcnc/" + name);
        }
        for (const char *folder : {"/../lib/millwright/", "/../lib/linuxcnc/"}) {
            candidates.push_back(program_folder() + folder + name);
        }
    }
    std::optional<Error> trouble;
    for (const std::string &path : candidates) {
        if (::access(path.c_str(), R_OK) == 0) {
            const Result<PluginFactory> found = factory_in(path);
            if (found) {
                return std::unique_ptr<ProgramInterpreter>((*found)(parts));
            }
            trouble = found.error();
        }
    }
    return std::unexpected(trouble.value_or(
        Error{fmt::format("the interpreter {} was not found: there is no {}", name, candidates.front())}));
}

}  // namespace mw::gcode
