// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/toolchain.hh"

#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <fmt/core.h>

#include "base/atomic_file.hh"
#include "hal/halcompile/object_file.hh"
#include "hal/halcompile/temporary_folder.hh"

extern char **environ;

namespace mw::halcompile {
namespace {

namespace fs = std::filesystem;

/// Symbols that the loader and the motion module search; exported with or without EXPORT_SYMBOL.
constexpr std::array<const char *, 8> ENTRY_POINTS{
    "rtapi_app_main", "rtapi_app_exit", "kinematicsForward",    "kinematicsInverse",
    "kinematicsHome", "kinematicsType", "kinematicsSwitchable", "kinematicsSwitch"};

/// Functions that a realtime function must not call; code that runs while loading may call them.
constexpr std::array<const char *, 33> SLOW_CALLS{"malloc",  "calloc",  "realloc",
                                                  "free",    "printf",  "puts",
                                                  "fprintf", "vprintf", "putchar",
                                                  "perror",  "fopen",   "fclose",
                                                  "fread",   "fwrite",  "fgets",
                                                  "open",    "close",   "read",
                                                  "write",   "ioctl",   "select",
                                                  "poll",    "socket",  "send",
                                                  "recv",    "sleep",   "nanosleep",
                                                  "usleep",  "system",  "fork",
                                                  "exit",    "abort",   "pthread_mutex_lock"};

bool isThere(const fs::path &path) {
    std::error_code ignored;
    return fs::exists(path, ignored);
}

std::string first_that_exists(const std::vector<fs::path> &candidates) {
    const auto found = std::find_if(candidates.begin(), candidates.end(), isThere);
    const fs::path chosen = found == candidates.end() ? candidates.front() : *found;
    return chosen.lexically_normal().string();
}

std::string environment(const char *name) {
    const char *value = std::getenv(name);
    return value == nullptr ? std::string() : value;
}

bool isCxx(const std::string &source) {
    const std::string suffix = fs::path(source).extension();
    return suffix == ".cc" || suffix == ".cpp" || suffix == ".cxx" || suffix == ".C";
}

/// The library for userspace components; with its version when the plain name is not installed.
std::string hal_library(const std::string &folder) {
    for (const char *name : {"libmillwright_hal.so", "libmillwright_hal.so.1"}) {
        if (isThere(fs::path(folder) / name)) {
            return folder + '/' + name;
        }
    }
    return {};
}

std::vector<std::string> compile_words(const Places &places, const BuildOrder &order,
                                       const std::string &object) {
    const bool realtime = order.kind == Kind::REALTIME;
    const std::string compiler = environment(isCxx(order.source) ? "CXX" : "CC");
    std::vector<std::string> words{compiler.empty() ? (isCxx(order.source) ? "g++" : "gcc") : compiler};
    words.insert(words.end(),
                 {"-c", "-o", object, "-O2", "-g1", "-fPIC", "-fno-strict-aliasing", "-ffp-contract=off",
                  "-D_GNU_SOURCE", "-DUSPACE", realtime ? "-DRTAPI" : "-DULAPI"});
    if (realtime) {
        words.insert(words.end(), {"-DREALTIME", "-D__MODULE__"});
    }
    if (isCxx(order.source)) {
        words.emplace_back("-std=gnu++20");  // required by <millwright/component.hh>
    }
    if (isCxx(order.source) && realtime) {
        words.insert(words.end(), {"-fno-exceptions", "-fno-rtti"});
        if (compiler.empty() || compiler.find("clang") == std::string::npos) {
            words.emplace_back("-fno-gnu-unique");
        }
    }
    words.push_back("-I" + places.include_folder);
    words.push_back("-I" + (order.source_folder.empty() ? std::string(".") : order.source_folder));
    words.insert(words.end(), order.compile_args.begin(), order.compile_args.end());
    words.push_back(order.source);
    return words;
}

std::vector<std::string> link_words(const Places &places, const BuildOrder &order, const std::string &object,
                                    const std::string &script) {
    const std::string compiler = environment(isCxx(order.source) ? "CXX" : "CC");
    std::vector<std::string> words{compiler.empty() ? (isCxx(order.source) ? "g++" : "gcc") : compiler};
    words.insert(words.end(), {"-o", order.output});
    if (order.kind == Kind::REALTIME) {
        words.insert(words.end(), {"-shared", "-Wl,-Bsymbolic", "-Wl,--version-script," + script});
    }
    words.push_back(object);
    words.push_back("-L" + places.library_folder);
    words.push_back("-L" + places.library_folder + "/millwright");
    words.insert(words.end(), order.link_args.begin(), order.link_args.end());
    if (order.kind == Kind::USERSPACE) {
        const std::string library = hal_library(places.library_folder);
        if (!library.empty()) {
            words.push_back(library);
        }
        words.push_back("-Wl,-rpath," + places.library_folder);
    }
    words.emplace_back("-lm");
    return words;
}

/// Exports only the symbols that other modules may use.
Result<> write_export_list(const ObjectFacts &facts, const std::string &path) {
    std::string text = "{\n  global:\n";
    for (const char *name : ENTRY_POINTS) {
        text += fmt::format("    {};\n", name);
    }
    for (const std::string &name : facts.exported) {
        text += fmt::format("    {};\n", name);
    }
    return write_file_atomically(path, text + "  local: *;\n};\n");
}

bool has(const std::vector<std::string> &names, std::string_view wanted) {
    return std::find(names.begin(), names.end(), wanted) != names.end();
}

Result<> run_tool(const std::vector<std::string> &words, const std::string &what) {
    const auto status = run_program(words);
    if (!status) {
        return std::unexpected(status.error());
    }
    return *status == 0 ? Result<>{} : fail(what);
}

}  // namespace

Places Places::of_program(const std::string &program) {
    const fs::path bin = fs::path(program).parent_path();
    const fs::path up = bin / "..";
    Places places;
    places.include_folder = first_that_exists({up / "include/millwright/hal.h", up / "include/hal.h"});
    places.include_folder = fs::path(places.include_folder).parent_path().string();
    std::vector<fs::path> libraries;
    for (const char *folder : {"lib", MW_LIBDIR, "lib64"}) {
        libraries.push_back(up / folder / "libmillwright_hal.so.1");
    }
    places.library_folder = fs::path(first_that_exists(libraries)).parent_path().string();
    const fs::path library(places.library_folder);
    const bool is_build_folder = isThere(up / "CMakeCache.txt");
    const std::string modules = environment("RTLIB_DIR");
    places.module_folder = !modules.empty()  ? modules
                           : is_build_folder ? places.library_folder
                                             : (library / "millwright/modules").string();
    const std::string home = environment("EMC2_HOME");
    const std::string programs = environment("USER_MODULE_DIR");
    places.program_folder = !programs.empty() ? programs : !home.empty() ? home + "/bin" : bin.string();
    places.man_folder = home.empty() ? (up / "share/man").lexically_normal().string() : home + "/man";
    places.data_folder = (up / "share/millwright").lexically_normal().string();
    return places;
}

Result<int> run_program(const std::vector<std::string> &words) {
    std::vector<char *> argv;
    for (const std::string &word : words) {
        argv.push_back(const_cast<char *>(word.c_str()));
    }
    argv.push_back(nullptr);
    pid_t pid = 0;
    if (const int code = ::posix_spawnp(&pid, argv[0], nullptr, nullptr, argv.data(), environ); code != 0) {
        return fail(fmt::format("cannot run {}: {}", words.front(), std::strerror(code)), {},
                    code == ENOENT ? "is it installed?" : "");
    }
    int status = 0;
    while (::waitpid(pid, &status, 0) < 0) {
        if (errno != EINTR) {
            return fail(fmt::format("cannot wait for {}: {}", words.front(), std::strerror(errno)));
        }
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

Result<std::vector<std::string>> build(const Places &places, const BuildOrder &order) {
    auto folder = TemporaryFolder::make();
    if (!folder) {
        return std::unexpected(folder.error());
    }
    const std::string object = folder->path() + "/object.o";
    const std::string script = folder->path() + "/exports";
    const std::string name = fs::path(order.source).filename();
    if (auto done = run_tool(compile_words(places, order, object), fmt::format("{} does not compile", name));
        !done) {
        return std::unexpected(done.error());
    }
    const auto bytes = read_file(object);
    if (!bytes) {
        return std::unexpected(bytes.error());
    }
    const auto facts = look_at_object(*bytes, object);
    if (!facts) {
        return std::unexpected(facts.error());
    }
    const bool realtime = order.kind == Kind::REALTIME;
    if (realtime && !has(facts->defined, "rtapi_app_main")) {
        return fail(fmt::format("{} has no rtapi_app_main", name), {},
                    "it is the entry point of a realtime module; compile a program with --userspace");
    }
    if (!realtime && !has(facts->defined, "main")) {
        return fail(fmt::format("{} has no main", name), {}, "a userspace component is a program");
    }
    if (realtime) {
        if (auto done = write_export_list(*facts, script); !done) {
            return std::unexpected(done.error());
        }
    }
    if (auto done =
            run_tool(link_words(places, order, object, script), fmt::format("{} does not link", name));
        !done) {
        return std::unexpected(done.error());
    }
    std::vector<std::string> slow;
    for (const char *call : SLOW_CALLS) {
        if (realtime && has(facts->undefined, call)) {
            slow.emplace_back(call);
        }
    }
    return slow;
}

Result<> install_file(const std::string &from, const std::string &to, unsigned mode) {
    const auto bytes = read_file(from);
    if (!bytes) {
        return std::unexpected(bytes.error());
    }
    std::error_code code;
    fs::create_directories(fs::path(to).parent_path(), code);
    if (auto done = write_file_atomically(to, *bytes); !done) {
        return fail(done.error().message, {}, "a system folder needs root: sudo halcompile ...");
    }
    if (::chmod(to.c_str(), mode) != 0) {
        return fail(fmt::format("cannot set the permissions of {}: {}", to, std::strerror(errno)));
    }
    return {};
}

Result<std::vector<std::string>> split_shell_words(const std::string &text) {
    std::vector<std::string> words;
    std::string word;
    bool in_word = false;
    char quote = '\0';
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '\\' && quote != '\'' && i + 1 < text.size()) {
            word += text[++i];
            in_word = true;
        } else if (quote != '\0') {
            if (c == quote) {
                quote = '\0';
            } else {
                word += c;
            }
        } else if (c == '"' || c == '\'') {
            quote = c;
            in_word = true;
        } else if (c == ' ' || c == '\t' || c == '\n') {
            if (in_word) {
                words.push_back(word);
            }
            word.clear();
            in_word = false;
        } else {
            word += c;
            in_word = true;
        }
    }
    if (quote != '\0') {
        return fail(fmt::format("a quote in '{}' is not closed", text));
    }
    if (in_word) {
        words.push_back(word);
    }
    return words;
}

}  // namespace mw::halcompile
