// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/halcompile/program.hh"

#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include <fmt/core.h>

#include "base/atomic_file.hh"
#include "base/diagnostics/sink.hh"
#include "base/language/language.hh"
#include "hal/halcompile/checker.hh"
#include "hal/halcompile/emit_man.hh"
#include "hal/halcompile/parser.hh"
#include "hal/halcompile/temporary_folder.hh"
#include "hal/halcompile/toolchain.hh"

namespace mw::halcompile {
namespace {

namespace fs = std::filesystem;

constexpr unsigned MODULE_MODE = 0644;
constexpr unsigned PROGRAM_MODE = 0755;

constexpr const char *USAGE = R"(halcompile: makes HAL components from .comp, C and Python files

  halcompile [--preprocess] FILE.comp...      write FILE.c
  halcompile --compile FILE.comp|FILE.c...    make FILE.so beside the source
  halcompile --install FILE.comp|FILE.c...    make it and put it where loadrt finds it
  halcompile --compile --userspace FILE.c...  make a program
  halcompile --install --userspace FILE.c|FILE.py...
  halcompile --document|--view-doc|--install-doc FILE.comp...
  halcompile --print-modinc                   the makefile for modules of several files

  --personalities=N         values that personality= takes (64)
  --extra-compile-args=ARGS, --extra-link-args=ARGS
  --require-license         a component without license is an error
  -o, --outfile=FILE        for one file
)";

/// Processes one file.
class Job {
  public:
    Job(const Options &options, const Places &places, const std::string &file)
        : options_(options), places_(places), file_(file), path_(file) {}

    bool run() {
        const std::string suffix = path_.extension();
        Result<> done;
        if (suffix == ".comp") {
            return run_component();
        }
        if (suffix == ".c" || suffix == ".cc" || suffix == ".cpp" || suffix == ".cxx") {
            done = run_source();
        } else if (suffix == ".py") {
            done = run_python();
        } else {
            done = fail(fmt::format("{}: halcompile does not support the suffix '{}'", file_, suffix), {},
                        ".comp, .c, .cc, .cpp, .py");
        }
        return report(done);
    }

  private:
    static bool report(const Result<> &done) {
        if (!done) {
            language::tell("halcompile", done.error());
        }
        return done.has_value();
    }

    /// Writes an output file; for an installation prints its path, which is not on the command line.
    Result<> put(const std::string &from, const std::string &to, unsigned mode) const {
        auto done = install_file(from, to, mode);
        if (done && (options_.mode == Mode::INSTALL || options_.mode == Mode::INSTALL_DOC)) {
            language::tell(fmt::format("halcompile: installed {}", to));
        }
        return done;
    }

    std::string beside(const std::string &name) const {
        return options_.output.empty() ? (path_.parent_path() / name).string() : options_.output;
    }

    bool run_component() {
        diagnostics::Sink sink([](const diagnostics::Diagnostic &one) { language::tell(one.str()); });
        const auto text = read_file(file_);
        if (!text) {
            return report(std::unexpected(text.error()));
        }
        const Component component = parse(*text, file_, sink);
        // After syntax errors most errors of the checker would be consequences.
        if (!sink.hasErrors()) {
            check(component, path_.stem(), sink);
        }
        if (options_.requiresLicense && !component.license) {
            sink.error("there is no license", component.place);
        }
        if (sink.hasErrors()) {
            return false;
        }
        return report(use(component));
    }

    Result<> use(const Component &component) {
        switch (options_.mode) {
        case Mode::PREPROCESS:
            return write_file_atomically(beside(component.name + ".c"),
                                         emit_c(component, options_.personalities));
        case Mode::DOCUMENT: return write_file_atomically(beside(page_name(component)), emit_man(component));
        case Mode::INSTALL_DOC: return install_page(component);
        case Mode::VIEW_DOC: return view(component);
        case Mode::INSTALL:
            if (auto done = compile(component); !done) {
                return done;
            }
            return install_page(component);
        default: return compile(component);
        }
    }

    static std::string page_name(const Component &component) {
        return fmt::format("{}.{}", component.name, man_section(component));
    }

    Result<> install_page(const Component &component) {
        const auto folder = TemporaryFolder::make();
        if (!folder) {
            return std::unexpected(folder.error());
        }
        const std::string page = folder->path() + "/page";
        if (auto done = write_file_atomically(page, emit_man(component)); !done) {
            return done;
        }
        return put(
            page,
            fmt::format("{}/man{}/{}", places_.man_folder, man_section(component), page_name(component)),
            MODULE_MODE);
    }

    Result<> view(const Component &component) {
        const auto folder = TemporaryFolder::make();
        if (!folder) {
            return std::unexpected(folder.error());
        }
        const std::string page = fmt::format("{}/{}", folder->path(), page_name(component));
        if (auto done = write_file_atomically(page, emit_man(component)); !done) {
            return done;
        }
        const auto status = run_program({"man", page});
        if (!status) {
            return std::unexpected(status.error());
        }
        return *status == 0 ? Result<>{} : fail("man could not show the page");
    }

    Result<> compile(const Component &component) {
        const auto folder = TemporaryFolder::make();
        if (!folder) {
            return std::unexpected(folder.error());
        }
        BuildOrder order;
        order.kind = component.isUserspace() ? Kind::USERSPACE : Kind::REALTIME;
        order.source = fmt::format("{}/{}.c", folder->path(), component.name);
        if (auto done = write_file_atomically(order.source, emit_c(component, options_.personalities));
            !done) {
            return done;
        }
        order.compile_args = options_.compile_args;
        order.link_args = options_.link_args;
        for (const auto &[option, words] : {std::pair{"extra_compile_args", &order.compile_args},
                                            std::pair{"extra_link_args", &order.link_args}}) {
            if (const Option *found = component.option(option)) {
                auto more = split_shell_words(found->value);
                if (!more) {
                    return std::unexpected(more.error());
                }
                words->insert(words->end(), more->begin(), more->end());
            }
        }
        auto made = make(std::move(order), component.name);
        if (!made && made.error().place.file.empty()) {  // the compiler has died without a message
            made.error().place = {component.file, component.code_line, 0};
        }
        return made;
    }

    Result<> run_source() {
        if (options_.mode != Mode::COMPILE && options_.mode != Mode::INSTALL) {
            return fail(fmt::format("{}: use --compile or --install for a C file", file_), {},
                        "--compile or --install");
        }
        BuildOrder order;
        order.kind = options_.userspace ? Kind::USERSPACE : Kind::REALTIME;
        order.source = file_;
        order.compile_args = options_.compile_args;
        order.link_args = options_.link_args;
        return make(std::move(order), path_.stem());
    }

    /// Builds into a temporary file, then moves it: a failure leaves no incomplete module.
    Result<> make(BuildOrder order, const std::string &name) {
        const auto folder = TemporaryFolder::make();
        if (!folder) {
            return std::unexpected(folder.error());
        }
        const bool realtime = order.kind == Kind::REALTIME;
        const std::string product = name + (realtime ? ".so" : "");
        order.source_folder = path_.parent_path();
        order.output = folder->path() + "/" + product;
        const auto slow = build(places_, order);
        if (!slow) {
            return std::unexpected(slow.error());
        }
        if (!slow->empty()) {
            std::string list;
            for (const std::string &call : *slow) {
                list += (list.empty() ? "" : ", ") + call;
            }
            language::tell(
                fmt::format("{}: note: it calls {}, which realtime functions must not call", file_, list));
        }
        const bool installed = options_.mode == Mode::INSTALL;
        const std::string to = !installed ? beside(product)
                               : realtime ? places_.module_folder + "/" + product
                                          : places_.program_folder + "/" + product;
        const bool executable = !realtime || !installed;
        return put(order.output, to, executable ? PROGRAM_MODE : MODULE_MODE);
    }

    Result<> run_python() {
        if (!options_.userspace) {
            return fail(fmt::format("{}: a Python component is a userspace component", file_), {},
                        "--userspace");
        }
        if (options_.mode != Mode::COMPILE && options_.mode != Mode::INSTALL) {
            return fail(
                fmt::format("{}: use --compile (checks the file) or --install for a Python file", file_));
        }
        const auto text = read_file(file_);
        if (!text) {
            return std::unexpected(text.error());
        }
        const auto status = run_program(
            {"python3", "-c", "import ast, sys; ast.parse(open(sys.argv[1]).read(), sys.argv[1])", file_});
        if (!status) {
            return std::unexpected(status.error());
        }
        if (*status != 0) {
            return fail(fmt::format("{} is not a Python program", file_));
        }
        if (!text->starts_with("#!")) {
            return fail(fmt::format("{} cannot be run as a program", file_), {file_, 1, 1},
                        "start it with: #!/usr/bin/env python3");
        }
        const std::string name = path_.stem();
        return put(file_, options_.mode == Mode::INSTALL ? places_.program_folder + "/" + name : beside(name),
                   PROGRAM_MODE);
    }

    const Options &options_;
    const Places &places_;
    std::string file_;
    fs::path path_;
};

}  // namespace

int run(const std::string &program, const std::vector<std::string> &arguments) {
    const auto options = parse_options(arguments);
    if (!options) {
        language::tell("halcompile", options.error());
        return 1;
    }
    const Places places = Places::of_program(program);
    if (options->mode == Mode::HELP) {
        std::fputs(language::shown(USAGE).c_str(), stdout);
        return 0;
    }
    if (options->mode == Mode::PRINT_MODINC) {
        std::puts((places.data_folder + "/Makefile.modinc").c_str());
        return 0;
    }
    if (options->files.empty()) {
        std::fputs(language::shown(USAGE).c_str(), stderr);
        return 1;
    }
    if (!options->output.empty() && options->files.size() > 1) {
        language::tell("halcompile: -o is possible with one file only");
        return 1;
    }
    bool good = true;
    for (const std::string &file : options->files) {
        good = Job(*options, places, file).run() && good;
    }
    return good ? 0 : 1;
}

}  // namespace mw::halcompile
