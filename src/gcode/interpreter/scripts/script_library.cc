// SPDX-License-Identifier: GPL-2.0-or-later
// The optional shared object with the script language.
#include <dlfcn.h>
#include <unistd.h>

#include <filesystem>

#include <fmt/format.h>

#include "base/own_place.hh"
#include "gcode/interpreter/scripts/script_host.hh"
#include "gcode/interpreter/scripts/script_stop.hh"

namespace mw::gcode {
namespace {

constexpr char LIBRARY[] = "python_host.so";

/// Folder of the file that contains this code: a program, or a Python module.
std::string own_file_folder() {
    Dl_info info{};
    if (::dladdr(reinterpret_cast<const void *>(&script_library), &info) == 0 || info.dli_fname == nullptr) {
        return ".";
    }
    return std::filesystem::path(info.dli_fname).parent_path().string();
}

}  // namespace

ScriptStop &script_stop() {
    static ScriptStop stop;
    return stop;
}

std::string script_library() {
    const std::string program = program_folder();
    const std::string own = own_file_folder();
    std::string first;
    for (const std::string &folder : {program + "/../lib/millwright/", own + "/../lib/millwright/",
                                      own + "/../millwright/", own + "/../../millwright/"}) {
        const std::string path = folder + LIBRARY;
        if (::access(path.c_str(), R_OK) == 0) {
            return path;
        }
        first = first.empty() ? path : first;
    }
    return first;
}

Result<std::unique_ptr<ScriptHost>> open_script_host(const std::string &file) {
    constexpr char HINT[] =
        "install the Python part of Millwright (built only if python3-dev and pybind11-dev are installed)";
    if (::access(file.c_str(), R_OK) != 0) {
        return fail(fmt::format("{} is not installed", file), {}, HINT);
    }
    // Never closed, because a Python interpreter cannot be unloaded. Global, because Python's own extensions
    // need its symbols.
    void *const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_GLOBAL);
    if (library == nullptr) {
        return fail(fmt::format("cannot load {}: {}", file, ::dlerror()), {}, HINT);
    }
    const auto make = reinterpret_cast<ScriptHostFactory>(::dlsym(library, SCRIPT_HOST_SYMBOL));
    ScriptHost *host = nullptr;
    if (make == nullptr || make(SCRIPT_HOST_VERSION, &host) == 0 || host == nullptr) {
        return fail(fmt::format("{} belongs to another version of Millwright", file), {}, HINT);
    }
    return std::unique_ptr<ScriptHost>(host);
}

}  // namespace mw::gcode
