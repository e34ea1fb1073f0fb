// SPDX-License-Identifier: GPL-2.0-or-later
// The shared library for Tcl shells: the commands emc_* of the package Linuxcnc.
#include <tcl.h>

#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "clients/nml/remote/find_machine.hh"
#include "clients/tcl/commands.hh"
#include "hal/core/instance.hh"

#define MW_EXPORT __attribute__((visibility("default")))

namespace mw::tcl {
namespace {

/// Interval in which jogs are renewed while the program processes events.
constexpr int RENEWAL_MS = 80;

/// The state of an interpreter; empty before emc_init.
struct Package {
    std::unique_ptr<Shell> shell;
    Tcl_TimerToken timer = nullptr;
};

struct Bound {
    const CommandRow *row;
    Package *package;
};

int answer(Tcl_Interp *tcl, const std::string &text, int code) {
    Tcl_SetObjResult(tcl, Tcl_NewStringObj(text.data(), static_cast<int>(text.size())));
    return code;
}

Words words_of(int count, Tcl_Obj *const objects[]) {
    Words words;
    for (int i = 1; i < count; ++i) {
        int bytes = 0;
        const char *const text = Tcl_GetStringFromObj(objects[i], &bytes);
        words.emplace_back(text, static_cast<std::size_t>(bytes));
    }
    return words;
}

void renew(ClientData data) {
    auto &package = *static_cast<Package *>(data);
    package.timer = nullptr;
    if (package.shell != nullptr && package.shell->isJogging()) {
        package.shell->keep_jogging();
        package.timer = Tcl_CreateTimerHandler(RENEWAL_MS, renew, data);
    }
}

int call(ClientData data, Tcl_Interp *tcl, int count, Tcl_Obj *const objects[]) {
    const Bound &bound = *static_cast<const Bound *>(data);
    const CommandRow &row = *bound.row;
    const int given = count - 1;
    if (given < row.least || given > row.most) {
        return answer(tcl,
                      fmt::format("wrong # args: should be \"{}{}{}\"", row.name, *row.usage != 0 ? " " : "",
                                  row.usage),
                      TCL_ERROR);
    }
    Package &package = *bound.package;
    if (package.shell == nullptr) {
        return answer(tcl, "emc not connected", TCL_ERROR);
    }
    if (const auto looked = package.shell->look(); !looked.has_value()) {
        return answer(tcl, looked.error().str(), TCL_ERROR);
    }
    const auto result = row.handler(*package.shell, words_of(count, objects));
    if (package.shell->isJogging() && package.timer == nullptr) {
        package.timer = Tcl_CreateTimerHandler(RENEWAL_MS, renew, &package);
    }
    return result.has_value() ? answer(tcl, *result, TCL_OK)
                              : answer(tcl, fmt::format("{}: {}", row.name, result.error().str()), TCL_ERROR);
}

/// The INI file in the words; empty: none.
std::string named_ini(const Words &words) {
    std::string path;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) {
        path = words[i] == "-ini" || words[i] == "--ini" ? words[i + 1] : path;
    }
    return path;
}

Result<ini::IniFile> load_ini(const std::string &path) {
    diagnostics::Sink quiet(
        [](const diagnostics::Diagnostic &) {});  // the machine has reported problems of the file
    std::error_code ignored;
    return ini::IniFile::load(std::filesystem::absolute(path, ignored).string(), quiet);
}

/// [EMC]NML_FILE, relative to the folder of the INI file; without this key the file of the environment.
std::string nml_file(const ini::IniFile &ini) {
    const ini::IniEntry *const entry = ini.find("EMC", "NML_FILE");
    return entry == nullptr || entry->value.empty()
               ? nml::nml_file_of_environment()
               : (std::filesystem::path(ini.path()).parent_path() / entry->value).string();
}

struct Found {
    client::Viewer viewer;
    ini::IniFile ini;
    std::string channels;  ///< NML file
};

/// The machine and an INI file: the named one, else that of the machine on this computer.
Result<Found> find(const std::string &instance, const std::string &named) {
    std::string channels = nml::nml_file_of_environment();
    Result<ini::IniFile> ini = fail("no INI file");
    if (!named.empty()) {
        ini = load_ini(named);
        if (!ini.has_value()) {
            return std::unexpected(ini.error());
        }
        channels = nml_file(*ini);
    }
    auto viewer = nml::find_machine(instance, channels);
    if (!viewer.has_value()) {
        return fail("no emc connection: " + viewer.error().str());
    }
    if (named.empty()) {
        if (viewer->link() != nullptr) {
            return fail("emc_init: the machine is on another computer, and so is its INI file", {},
                        "emc_init -ini FILE");
        }
        ini = load_ini(viewer->identity().ini.str());
        if (!ini.has_value()) {
            return std::unexpected(ini.error());
        }
    }
    return Found{std::move(*viewer), std::move(*ini), std::move(channels)};
}

/// emc_init [-ini FILE] [-quick]
int init(ClientData data, Tcl_Interp *tcl, int count, Tcl_Obj *const objects[]) {
    auto &package = *static_cast<Package *>(data);
    const std::string instance = hal::default_instance();
    auto found = find(instance, named_ini(words_of(count, objects)));
    if (!found.has_value()) {
        return answer(tcl, found.error().str(), TCL_ERROR);
    }
    Tcl_SetVar2(tcl, "EMC_INIFILE", nullptr, found->ini.path().c_str(), TCL_GLOBAL_ONLY);
    const auto join = [instance, channels = found->channels]() -> Result<client::Client> {
        auto viewer = nml::find_machine(instance, channels);
        return viewer.has_value() ? client::Client::join(std::move(*viewer))
                                  : std::unexpected(viewer.error());
    };
    package.shell = std::make_unique<Shell>(std::move(found->viewer), join, std::move(found->ini));
    return answer(tcl, "", TCL_OK);
}

/// When a program exits, it leaves the machine, and its jogs stop.
void leave(ClientData data) {
    static_cast<Package *>(data)->shell.reset();
}

void forget(ClientData data, Tcl_Interp *) {
    auto *const package = static_cast<Package *>(data);
    Tcl_DeleteExitHandler(leave, package);
    if (package->timer != nullptr) {
        Tcl_DeleteTimerHandler(package->timer);
    }
    delete package;
}

void forget_bound(ClientData data) {
    delete static_cast<Bound *>(data);
}

}  // namespace
}  // namespace mw::tcl

extern "C" MW_EXPORT int Linuxcnc_Init(Tcl_Interp *tcl) {
    using namespace mw::tcl;
    if (Tcl_PkgRequire(tcl, "Tcl", "8.6", 0) == nullptr) {
        return TCL_ERROR;
    }
    auto *const package = new Package;  // owned by the interpreter until it is deleted
    Tcl_CallWhenDeleted(tcl, forget, package);
    Tcl_CreateExitHandler(leave, package);
    Tcl_CreateObjCommand(tcl, "emc_init", init, package, nullptr);
    for (const auto &table : {questions(), orders(), settings()}) {
        for (const CommandRow &row : table) {
            Tcl_CreateObjCommand(tcl, row.name, call, new Bound{&row, package}, forget_bound);
        }
    }
    return TCL_OK;
}
