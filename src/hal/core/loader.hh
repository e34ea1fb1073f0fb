// SPDX-License-Identifier: GPL-2.0-or-later
// Realtime modules: shared objects with rtapi_app_main and rtapi_app_exit. [one non-realtime thread]
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.hh"

struct rtapi_mp_info;

namespace mw::hal {

class Instance;

class Loader {
  public:
    /// Searches NAME.so in `folders` and loads the first match.
    Loader(Instance &hal, std::vector<std::string> folders);
    /// Unloads all modules, newest first.
    ~Loader();
    Loader(const Loader &) = delete;
    Loader &operator=(const Loader &) = delete;

    /// $MILLWRIGHT_MODULE_PATH (colon separated), then the module folder relative to this program (../lib in
    /// a build folder, ../lib/millwright/modules when installed).
    static std::vector<std::string> default_folders();

    /// True while this thread runs the rtapi_app_main of a module. [any thread]
    static bool isLoading() noexcept;
    /// Declares a parameter of the module that this thread loads. [any thread]
    static void add_parameter(const rtapi_mp_info *info);

    /// Loads a module and runs its rtapi_app_main with `args` ("count=2", "names=a,b"). Every instance and
    /// every load has its own module statics. After a failure nothing of the module remains; the message
    /// includes the module's log.
    Result<> load(const std::string &name, const std::vector<std::string> &args);
    /// Runs rtapi_app_exit. Rejected while another module uses its symbols.
    Result<> unload(const std::string &name);
    Result<> unload_all();
    bool isLoaded(std::string_view name) const;
    /// The loaded modules, newest last.
    std::vector<std::string> modules() const;

    /// A symbol that a loaded module exports (newest first), or null.
    void *find_symbol(const char *symbol) const;
    /// Keeps the module that exports `symbol` loaded until component `comp_id` ends.
    Result<> use(const char *symbol, int comp_id);

  private:
    struct Module;
    Result<> set_parameters(Module &module, const std::vector<std::string> &args);
    Result<> open(Module &module);
    std::string link(Module &module, const std::string &path);
    /// The newest loaded module that exports the symbol, or null.
    Module *exporter_of(const char *symbol) const;
    Result<> run_main(Module &module);
    void close(Module &module);
    std::string find_file(const std::string &name) const;

    Instance &hal_;
    std::vector<std::string> folders_;
    std::vector<std::unique_ptr<Module>> modules_;
};

}  // namespace mw::hal
