// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/loader.hh"

#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <filesystem>
#include <limits>
#include <mutex>

#include "base/own_place.hh"
#include "base/text.hh"
#include "hal/core/command_hints.hh"
#include "hal/core/detail/context.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/instance.hh"
#include "hal/include/rtapi.h"

namespace mw::hal {

using namespace detail;

struct Loader::Module {
    std::string name;
    std::string file;
    void *handle = nullptr;
    std::vector<const rtapi_mp_info *> parameters;
    std::deque<std::string> texts;  ///< storage for the values of string parameters
    std::vector<int> comp_ids;      ///< components of its rtapi_app_main
    std::vector<int> users;         ///< components that use its symbols
    std::vector<std::string> uses;  ///< modules whose symbols it uses
};

namespace {

/// A parameter as in a HAL file, with its value in quotes if it contains blanks.
std::string quoted(const std::string &arg) {
    const std::size_t equals = arg.find('=');
    if (equals == std::string::npos || arg.find_first_of(" \t") == std::string::npos) {
        return arg;
    }
    return arg.substr(0, equals + 1) + '"' + arg.substr(equals + 1) + '"';
}

/// Names of existing shared objects.
std::vector<std::string> modules_in(const std::vector<std::string> &folders) {
    constexpr std::string_view ENDING = ".so";
    std::vector<std::string> names;
    for (const std::string &folder : folders) {
        std::error_code ignored;
        for (const auto &entry : std::filesystem::directory_iterator(folder, ignored)) {
            std::string name = entry.path().filename().string();
            if (name.ends_with(ENDING)) {
                names.push_back(name.substr(0, name.size() - ENDING.size()));
            }
        }
    }
    return names;
}

/// Repeats errors that a module logs while it is loaded in the failure.
struct LogTap {
    runtime::Log &log;
    runtime::Log::Sink sink = &LogTap::receive;
    void *context = this;
    std::string last_error;

    explicit LogTap(runtime::Log &of) : log(of) { log.swap_sink(sink, context); }
    ~LogTap() { log.swap_sink(sink, context); }
    LogTap(const LogTap &) = delete;
    LogTap &operator=(const LogTap &) = delete;

    static void receive(void *self, runtime::LogLevel level, const char *text) {
        auto *tap = static_cast<LogTap *>(self);
        if (level == runtime::LogLevel::ERR) {
            tap->last_error = text;
        }
        tap->sink(tap->context, level, text);
    }
};

Result<> set_number(const rtapi_mp_info &info, int index, std::string_view text) {
    const auto value = parse_c_int(text);
    const bool is_int = info.mp_type == RTAPI_MP_TYPE_INT;
    if (!value ||
        (is_int && (*value < std::numeric_limits<int>::min() || *value > std::numeric_limits<int>::max()))) {
        return refuse(EINVAL, fmt::format("parameter '{}': '{}' is not a whole number{}", info.mp_name, text,
                                          is_int ? " of 32 bits" : ""));
    }
    if (is_int) {
        static_cast<int *>(info.mp_address)[index] = static_cast<int>(*value);
    } else {
        static_cast<long *>(info.mp_address)[index] = *value;
    }
    return {};
}

Result<> set_parameter(const rtapi_mp_info &info, std::string_view text, std::deque<std::string> &texts) {
    const bool is_text = info.mp_type == RTAPI_MP_TYPE_STRING;
    if (info.mp_count > 1 && text.empty()) {
        return {};
    }
    for (int index = 0;; ++index) {
        if (index == info.mp_count) {
            return refuse(EINVAL,
                          fmt::format("parameter '{}' takes at most {} values", info.mp_name, info.mp_count));
        }
        const std::size_t comma = info.mp_count > 1 ? text.find(',') : std::string_view::npos;
        const std::string_view word = text.substr(0, comma);
        if (is_text) {
            static_cast<char **>(info.mp_address)[index] = texts.emplace_back(word).data();
        } else if (auto set = set_number(info, index, word); !set) {
            return set;
        }
        if (comma == std::string_view::npos) {
            return {};
        }
        text.remove_prefix(comma + 1);
    }
}

/// Copies the module in memory. The linker treats the copy as another library with its own statics.
int copy_in_memory(const std::string &file) {
    const int from = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    const int to = ::memfd_create("millwright-module", MFD_CLOEXEC);
    struct stat status{};
    bool copied = from >= 0 && to >= 0 && ::fstat(from, &status) == 0;
    for (off_t left = copied ? status.st_size : 0; left > 0;) {
        const ssize_t sent = ::sendfile(to, from, nullptr, static_cast<std::size_t>(left));
        if (sent <= 0) {
            copied = false;
            break;
        }
        left -= sent;
    }
    if (from >= 0) {
        ::close(from);
    }
    if (!copied && to >= 0) {
        ::close(to);
        return -1;
    }
    return to;
}

/// Address of a module in memory.
const void *module_base(void *handle) {
    Dl_info info{};
    void *main = ::dlsym(handle, "rtapi_app_main");
    return main != nullptr && ::dladdr(main, &info) != 0 ? info.dli_fbase : nullptr;
}

/// The symbol in the dynamic linker's message about an undefined symbol; empty for other messages.
std::string missing_symbol(const std::string &message) {
    constexpr std::string_view MARK = "undefined symbol: ";
    const std::size_t at = message.find(MARK);
    if (at == std::string::npos) {
        return {};
    }
    const std::size_t start = at + MARK.size();
    return message.substr(start, message.find_first_of(" ,(", start) - start);
}

}  // namespace

Loader::Loader(Instance &hal, std::vector<std::string> folders) : hal_(hal), folders_(std::move(folders)) {
    hal_.set_loader(this);
}

Loader::~Loader() {
    (void)unload_all();
    hal_.set_loader(nullptr);
}

std::vector<std::string> Loader::default_folders() {
    std::vector<std::string> folders;
    if (const char *path = std::getenv("MILLWRIGHT_MODULE_PATH")) {
        std::string_view rest = path;
        while (!rest.empty()) {
            const std::size_t colon = rest.find(':');
            if (colon != 0) {
                folders.emplace_back(rest.substr(0, colon));
            }
            rest.remove_prefix(colon == std::string_view::npos ? rest.size() : colon + 1);
        }
    }
    const std::string here = program_folder();
    folders.push_back(here + "/../lib");
    folders.push_back(here + "/../lib/millwright/modules");
    folders.push_back(here + "/../lib/linuxcnc/modules");
    folders.push_back(here + "/../lib/linuxcnc");
    return folders;
}

bool Loader::isLoading() noexcept {
    return context().loading != nullptr;
}

void Loader::add_parameter(const rtapi_mp_info *info) {
    // Programs and libraries that include the macros but are not loaded as modules have no receiver.
    if (auto *parameters = context().parameters) {
        parameters->push_back(info);
    }
}

std::string Loader::find_file(const std::string &name) const {
    for (const std::string &folder : folders_) {
        const std::string file = folder + '/' + name + ".so";
        if (::access(file.c_str(), R_OK) == 0) {
            return file;
        }
    }
    return {};
}

bool Loader::isLoaded(std::string_view name) const {
    return std::any_of(modules_.begin(), modules_.end(),
                       [&](const auto &module) { return module->name == name; });
}

std::vector<std::string> Loader::modules() const {
    std::vector<std::string> names;
    for (const auto &module : modules_) {
        names.push_back(module->name);
    }
    return names;
}

Result<> Loader::open(Module &module) {
    // If two threads open one file, only one may treat it as the first.
    static std::mutex opening;
    const std::lock_guard lock(opening);
    std::string path = module.file;
    int copy = -1;
    if (void *loaded = ::dlopen(path.c_str(), RTLD_NOW | RTLD_NOLOAD)) {
        ::dlclose(loaded);
        copy = copy_in_memory(module.file);
        if (copy < 0) {
            return refuse(EIO, fmt::format("module '{}': cannot copy {}: {}", module.name, module.file,
                                           std::strerror(errno)));
        }
        path = fmt::format("/proc/self/fd/{}", copy);
    }
    const std::string why = link(module, path);
    if (copy >= 0) {
        ::close(copy);
    }
    if (module.handle == nullptr) {
        return refuse(ENOEXEC, fmt::format("{}: dlopen: {}", module.name, why));
    }
    return {};
}

/// Opens the file. A missing symbol is taken from a loaded module that exports it: that module's symbols
/// become visible to later ones, and it stays loaded while this one uses it. Returns the reason of a failure;
/// empty on success.
std::string Loader::link(Module &module, const std::string &path) {
    std::string last_missing;
    while (true) {
        context().parameters = &module.parameters;
        module.handle = ::dlopen(path.c_str(), RTLD_LOCAL | RTLD_NOW);
        context().parameters = nullptr;
        if (module.handle != nullptr) {
            return {};
        }
        const std::string why = ::dlerror();
        const std::string missing = missing_symbol(why);
        Module *exporter =
            missing.empty() || missing == last_missing ? nullptr : exporter_of(missing.c_str());
        if (exporter == nullptr) {
            return why;
        }
        last_missing = missing;
        module.parameters.clear();
        link_map *map = nullptr;
        if (::dlinfo(exporter->handle, RTLD_DI_LINKMAP, &map) == 0) {
            if (void *again = ::dlopen(map->l_name, RTLD_NOW | RTLD_NOLOAD | RTLD_GLOBAL)) {
                ::dlclose(again);
            }
        }
        module.uses.push_back(exporter->name);
    }
}

Result<> Loader::set_parameters(Module &module, const std::vector<std::string> &args) {
    std::vector<std::string> known;
    for (const rtapi_mp_info *info : module.parameters) {
        known.emplace_back(info->mp_name);
    }
    for (const std::string &arg : args) {
        const std::size_t equals = arg.find('=');
        if (equals == std::string::npos) {
            return refuse(EINVAL,
                          fmt::format("module '{}': '{}' is not of the form name=value", module.name, arg));
        }
        const std::string name = arg.substr(0, equals);
        const auto found = std::find(known.begin(), known.end(), name);
        if (found == known.end()) {
            std::string list;
            for (const std::string &one : known) {
                list += (list.empty() ? "" : ", ") + one;
            }
            const std::string near = nearest_name(name, known);
            return refuse(EINVAL,
                          fmt::format("module '{}' has no parameter '{}'; it has {}", module.name, name,
                                      list.empty() ? "none" : list),
                          near.empty() ? std::string() : fmt::format("did you mean '{}'?", near));
        }
        const rtapi_mp_info &info = *module.parameters[static_cast<std::size_t>(found - known.begin())];
        if (auto set = set_parameter(info, std::string_view(arg).substr(equals + 1), module.texts); !set) {
            return refuse(EINVAL, fmt::format("module '{}': {}", module.name, set.error().message));
        }
    }
    return {};
}

Result<> Loader::run_main(Module &module) {
    auto *main = reinterpret_cast<int (*)()>(::dlsym(module.handle, "rtapi_app_main"));
    if (main == nullptr) {
        return refuse(ENOEXEC,
                      fmt::format("{} is not a realtime module: it has no rtapi_app_main", module.file));
    }
    const int first_id = hal_.components().next_id();
    LogTap tap(hal_.log());
    const UseInstance use(&hal_);
    context().loading = module.name.c_str();
    const int status = main();
    context().loading = nullptr;
    hal_.log().drain();
    for (const CompInfo &comp : hal_.components().list()) {
        if (comp.id >= first_id && comp.type != CompType::USER && comp.pid == ::getpid()) {
            module.comp_ids.push_back(comp.id);
        }
    }
    if (status < 0) {
        return refuse(-status,
                      fmt::format("module '{}': {}{}{} ({})", module.name, tap.last_error,
                                  tap.last_error.empty() ? "" : ": ", std::strerror(-status), status));
    }
    return {};
}

Result<> Loader::load(const std::string &name, const std::vector<std::string> &args) {
    if ((hal_.lock() & LOCK_LOAD) != 0) {
        return refuse(EPERM, "HAL is locked against loading", "unlock it with the command 'unlock'");
    }
    if (isLoaded(name)) {
        return refuse(EEXIST, fmt::format("module '{}' is loaded already", name));
    }
    auto module = std::make_unique<Module>();
    module->name = name;
    module->file = find_file(name);
    if (module->file.empty() || name.find('/') != std::string::npos) {
        std::string places;
        for (const std::string &folder : folders_) {
            places += (places.empty() ? "" : ", ") + folder;
        }
        const std::string instead = hint_for_absent(name);
        if (!instead.empty()) {
            return refuse(ENOENT, fmt::format("there is no module '{}'", name), instead);
        }
        const std::string near = nearest_name(name, modules_in(folders_));
        return refuse(ENOENT, fmt::format("there is no module '{}.so' in {}", name, places),
                      near.empty() ? "" : fmt::format("did you mean '{}'?", near));
    }
    auto done = open(*module);
    if (done) {
        done = set_parameters(*module, args);
    }
    if (done) {
        done = run_main(*module);
    }
    if (!done) {
        close(*module);
        return done;
    }
    std::string text;
    for (const std::string &arg : args) {
        text += (text.empty() ? "" : " ") + quoted(arg);
    }
    for (const int id : module->comp_ids) {
        const auto comp = hal_.components().find(id);
        if (comp && comp->type == CompType::REALTIME) {
            (void)hal_.components().set_insmod_args(id, text);
        }
    }
    modules_.push_back(std::move(module));
    return {};
}

/// Removes everything that the module left, then the module.
void Loader::close(Module &module) {
    for (const int id : module.comp_ids) {
        const auto comp = hal_.components().find(id);
        if (comp && comp->type == CompType::OTHER && comp->name.starts_with("__")) {
            (void)hal_.threads().remove(std::string_view(comp->name).substr(2));
        } else if (comp) {
            (void)hal_.components().remove(id);
        }
    }
    if (module.handle != nullptr) {
        ::dlclose(module.handle);
        module.handle = nullptr;
    }
}

Result<> Loader::unload(const std::string &name) {
    const auto found = std::find_if(modules_.begin(), modules_.end(),
                                    [&](const auto &module) { return module->name == name; });
    if (found == modules_.end()) {
        return refuse(ENOENT, fmt::format("module '{}' is not loaded", name));
    }
    for (const auto &other : modules_) {
        if (std::find(other->uses.begin(), other->uses.end(), name) != other->uses.end()) {
            return refuse(EBUSY, fmt::format("module '{}' is used by module '{}'", name, other->name));
        }
    }
    for (const int user : (*found)->users) {
        if (const auto comp = hal_.components().find(user)) {
            return refuse(EBUSY, fmt::format("module '{}' is used by component '{}'", name, comp->name));
        }
    }
    {
        const UseInstance use(&hal_);
        if (auto *exit = reinterpret_cast<void (*)()>(::dlsym((*found)->handle, "rtapi_app_exit"))) {
            context().unloading = name.c_str();
            exit();
            context().unloading = nullptr;
        }
    }
    close(**found);
    modules_.erase(found);
    return {};
}

Result<> Loader::unload_all() {
    Result<> first_failure;
    (void)hal_.threads().stop();
    // Modules are usually unloaded before the modules that they use. After a reload the order may differ, so
    // several rounds are needed.
    for (std::size_t rounds = modules_.size(); rounds > 0 && !modules_.empty(); --rounds) {
        for (std::size_t i = modules_.size(); i > 0; --i) {
            const std::string name = modules_[i - 1]->name;
            if (auto done = unload(name); !done) {
                first_failure = done;
            }
        }
    }
    return modules_.empty() ? Result<>{} : first_failure;
}

Loader::Module *Loader::exporter_of(const char *symbol) const {
    for (auto module = modules_.rbegin(); module != modules_.rend(); ++module) {
        if (void *address = ::dlsym((*module)->handle, symbol)) {
            Dl_info info{};
            // dlsym also searches the libraries that the module needs; those are not the module's own.
            const bool own = ::dladdr(address, &info) != 0 && info.dli_fbase != nullptr &&
                             info.dli_fbase == module_base((*module)->handle);
            if (own) {
                return module->get();
            }
        }
    }
    return nullptr;
}

void *Loader::find_symbol(const char *symbol) const {
    const Module *exporter = exporter_of(symbol);
    return exporter == nullptr ? nullptr : ::dlsym(exporter->handle, symbol);
}

Result<> Loader::use(const char *symbol, int comp_id) {
    Module *exporter = exporter_of(symbol);
    if (exporter == nullptr) {
        return refuse(ENOENT, fmt::format("no loaded module has the symbol '{}'", symbol));
    }
    exporter->users.push_back(comp_id);
    return {};
}

}  // namespace mw::hal
