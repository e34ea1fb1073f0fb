// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/session.hh"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/language/language.hh"
#include "base/own_place.hh"
#include "base/text.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

/// Also reads pipes, for `halcmd -f <(program)`.
Result<std::string> read_anything(const std::string &path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        return fail(fmt::format("cannot open '{}'", path), {path, 0, 0});
    }
    return std::string(std::istreambuf_iterator<char>(file), {});
}

/// Limit for HAL files that run each other recursively.
constexpr std::size_t MAX_DEPTH = 32;
constexpr std::string_view LIBRARY_PREFIX = "LIB:";

bool isFile(const std::string &path) {
    struct stat info{};
    return stat(path.c_str(), &info) == 0 && S_ISREG(info.st_mode);
}

std::string folder_of(const std::string &path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "." : path.substr(0, slash);
}

/// Names of the HAL files in these folders.
std::vector<std::string> hal_files_in(const std::vector<std::string> &folders) {
    std::vector<std::string> names;
    for (const std::string &folder : folders) {
        std::error_code ignored;
        for (const auto &entry : std::filesystem::directory_iterator(folder, ignored)) {
            const std::string name = entry.path().filename().string();
            if (name.ends_with(".hal") || name.ends_with(".tcl")) {
                names.push_back(name);
            }
        }
    }
    return names;
}

std::string joined(const std::vector<std::string> &parts, const char *separator) {
    std::string text;
    for (const std::string &part : parts) {
        text += (text.empty() ? "" : separator) + part;
    }
    return text;
}

void print(std::FILE *file, std::string_view text, bool endsLine) {
    std::fwrite(text.data(), 1, text.size(), file);
    if (endsLine) {
        std::fputc('\n', file);
    }
    // Flushes, because programs started by loadusr write to the same file and the order must be kept.
    std::fflush(file);
}

}  // namespace

std::string program_folder() {
    char path[4096];
    const ssize_t length = readlink("/proc/self/exe", path, sizeof path);
    return length <= 0 ? "." : folder_of(std::string(path, static_cast<std::size_t>(length)));
}

void StandardOutput::data(std::string_view text) {
    print(stdout, text, false);
}

void StandardOutput::info(std::string_view text) {
    print(stdout, text, true);
}

void StandardOutput::note(std::string_view text) {
    print(stderr, text, true);
}

void StandardOutput::warning(const Error &warning) {
    Error shown = warning;
    shown.message = "warning: " + shown.message;
    print(stderr, language::shown(shown.str()), true);
}

void StandardOutput::error(const Error &error) {
    print(stderr, language::shown(error.str()), true);
}

Session::Session(Host &host, ProgramHost &programs, Output &output, SessionOptions options)
    : host_(host), programs_(programs), output_(&output), options_(std::move(options)),
      placeholders_(host.hal()) {}

void Session::info(const SourcePlace &place, std::string_view text) {
    if (options_.verbosity >= Verbosity::RESULTS) {
        const std::string where = place.file.empty() ? "" : place.str();
        output_->info(where.empty() ? std::string(text) : fmt::format("{}: {}", where, text));
    }
}

void Session::warn(const SourcePlace &place, std::string_view text, std::string hint) {
    if (options_.verbosity >= Verbosity::ERRORS) {
        output_->warning(
            Error{std::string(text), place.file.empty() ? SourcePlace{} : place, std::move(hint)});
    }
}

void Session::report(const Error &error) {
    if (options_.verbosity < Verbosity::ERRORS) {
        return;
    }
    Error shown = error;
    if (shown.place.file.empty()) {
        // A typed command or one from a command line has no useful line number.
        shown.place = {};
    }
    output_->error(shown);
}

Result<std::string> Session::find_file(const std::string &name) const {
    std::vector<std::string> tried;
    std::string plain = name;
    if (name.starts_with(LIBRARY_PREFIX)) {
        plain = name.substr(LIBRARY_PREFIX.size());
        tried = options_.library;
    } else {
        if (isFile(name) || name.starts_with('/')) {
            return name;
        }
        if (!running_.empty()) {
            tried.push_back(folder_of(running_.back()));
        }
        tried.insert(tried.end(), options_.folders.begin(), options_.folders.end());
        tried.insert(tried.end(), options_.library.begin(), options_.library.end());
    }
    for (const std::string &folder : tried) {
        std::string path = folder + '/' + plain;
        if (isFile(path)) {
            return path;
        }
    }
    const bool in_library = name.starts_with(LIBRARY_PREFIX);
    const std::string folders = joined(tried, ", ");
    const std::string looked = tried.empty() && in_library ? "there is no library folder"
                               : tried.empty()             ? "searched in the working folder"
                               : in_library                ? fmt::format("searched in {}", folders)
                                            : fmt::format("searched in the working folder, {}", folders);
    tried.push_back(in_library ? "" : ".");
    const std::string near = nearest_name(plain, hal_files_in(tried));
    const std::string prefix = in_library ? std::string(LIBRARY_PREFIX) : "";
    return fail(fmt::format("HAL file '{}' not found", name), {},
                near.empty() ? looked : fmt::format("did you mean '{}{}'? {}", prefix, near, looked));
}

Result<> Session::run_script(const std::string &path, const std::vector<std::string> &arguments) {
    const Result<ScriptRunner *> runner = tcl();
    if (!runner) {
        // For a file named in a command, the command reports the error.
        if (running_.empty()) {
            report(runner.error());
        }
        return std::unexpected(runner.error());
    }
    running_.push_back(path);
    const Result<> result = (*runner)->run_file(path, arguments);
    running_.pop_back();
    if (!result) {
        report(result.error());
    }
    return result;
}

Result<ScriptRunner *> Session::tcl() {
    if (tcl_ == nullptr) {
        auto loaded = load_tcl(*this);
        if (!loaded) {
            return std::unexpected(loaded.error());
        }
        tcl_ = std::move(*loaded);
    }
    return tcl_.get();
}

Result<> Session::run_file(const std::string &name, const std::vector<std::string> &arguments) {
    const auto read = [&]() -> Result<std::pair<std::string, std::string>> {
        if (!options_.has_files) {
            return fail(fmt::format("HAL file '{}' cannot be run: files cannot be read here", name));
        }
        const Result<std::string> path = find_file(name);
        if (!path) {
            return std::unexpected(path.error());
        }
        if (running_.size() >= MAX_DEPTH) {
            return fail(fmt::format("'{}' calls itself: {} files deep", name, MAX_DEPTH));
        }
        if (path->ends_with(".tcl")) {
            return std::pair{*path, std::string()};
        }
        if (!arguments.empty()) {
            return fail(fmt::format("HAL file '{}' takes no arguments, '{}' is given", name, arguments[0]));
        }
        auto text = options_.are_pipes_read ? read_anything(*path) : read_file(*path);
        if (!text) {
            return std::unexpected(text.error());
        }
        return std::pair{*path, std::move(*text)};
    };
    const auto file = read();
    if (!file) {
        // For a file named in a command, the command reports the error.
        if (running_.empty()) {
            report(file.error());
        }
        return std::unexpected(file.error());
    }
    if (file->first.ends_with(".tcl")) {
        return run_script(file->first, arguments);
    }
    return run_text(without_byte_order_mark(file->second), file->first);
}

Result<> Session::run_text(std::string_view text, const std::string &name, int first_line) {
    Result<> first;
    running_.push_back(name);
    for (const LogicalLine &line : split_lines(text, first_line)) {
        const Result<> result = run_line(line, name);
        if (!result) {
            first = first ? result : first;
            if (!options_.keepsGoing) {
                break;
            }
        }
        if (ended_) {
            break;
        }
    }
    running_.pop_back();
    return first;
}

Result<> Session::run_line(const LogicalLine &line, const std::string &file) {
    if (options_.stop != nullptr && *options_.stop != 0) {
        ended_ = true;
        return fail("stopped", {file, line.first_line, 0});
    }
    if (options_.isEchoing) {
        output_->note(fmt::format("({})<echo>: {}", line.first_line, trim(line.text.text())));
    }
    if (constexpr std::size_t LONGEST = 65536; line.text.size() > LONGEST) {
        const auto refused = fail(
            fmt::format("a command with its continuation lines has {} characters, at most {} are allowed",
                        line.text.size(), LONGEST),
            {file, line.first_line, 1});
        report(refused.error());
        return refused;
    }
    const Result<PlacedText> text = substitute(line.text, file, Variables{nullptr, options_.ini});
    if (!text) {
        report(text.error());
        return std::unexpected(text.error());
    }
    const Result<std::vector<Word>> words = split_words(*text, file);
    if (!words) {
        report(words.error());
        return std::unexpected(words.error());
    }
    return run_command(*words);
}

Result<> Session::run_words(const std::vector<std::string> &words) {
    std::vector<Word> placed;
    for (const std::string &word : words) {
        placed.push_back(Word{word, word, {}});
    }
    return run_command(placed);
}

namespace {

/// Keeps the results of commands; other output is passed on.
class AnswerOutput final : public Output {
  public:
    explicit AnswerOutput(Output &rest) : rest_(rest) {}
    void data(std::string_view text) override { answer += text; }
    void info(std::string_view text) override { rest_.info(text); }
    void note(std::string_view text) override { rest_.note(text); }
    void warning(const Error &warning) override { rest_.warning(warning); }
    void error(const Error &) override {}

    std::string answer;

  private:
    Output &rest_;
};

}  // namespace

Result<std::string> Session::call(const std::vector<std::string> &words) {
    AnswerOutput output(*output_);
    Output *before = output_;
    output_ = &output;
    const Result<> result = run_words(words);
    output_ = before;
    if (!result) {
        return std::unexpected(result.error());
    }
    return output.answer;
}

/// Runs a command whose words have been counted, if it belongs to this pass.
Result<> Session::run_call(const Call &call) {
    const CommandSpec &spec = call.spec;
    const bool is_load = spec.run == script::run_loadrt || spec.run == script::run_loadusr;
    if (options_.pass == Pass::REST && is_load) {
        return {};
    }
    if (options_.pass == Pass::LOADS) {
        if (spec.run == script::run_loadrt) {
            return options_.loads->add(call);
        }
        if (is_load) {
            options_.loads->starting(call);
        }
        const bool is_run = is_load || spec.run == script::run_source || spec.run == script::run_list ||
                            spec.run == script::run_save || spec.run == script::run_exit;
        if (!is_run) {
            return {};
        }
    }
    return spec.run(*this, call);
}

Result<> Session::run_command(const std::vector<Word> &words) {
    if (words.empty()) {
        return {};
    }
    if (options_.verbosity >= Verbosity::EVERYTHING) {
        std::string text = words[0].raw;
        for (std::size_t i = 1; i < words.size(); ++i) {
            text += " " + words[i].raw;
        }
        info(words[0].place, text);
    }
    // "name = value" means setp.
    const bool is_assignment = words.size() >= 2 && words[1].raw == "=";
    const CommandSpec *spec = find_command(is_assignment ? "setp" : words[0].text);
    if (spec == nullptr) {
        const Error error = unknown_command(words[0]);
        report(error);
        return std::unexpected(error);
    }
    Call call{*spec, words[0].place, {}};
    for (std::size_t i = is_assignment ? 0 : 1; i < words.size(); ++i) {
        const bool skipped = (is_assignment && i == 1) || (spec->ignoresArrows && isArrow(words[i].raw));
        if (!skipped) {
            call.words.push_back(words[i]);
        }
    }
    Result<> result = check_words(call);
    if (result) {
        const bool sourcing = spec->run == run_source;
        const std::size_t depth = running_.size();
        result = at(run_call(call), call.place);
        // Errors of commands in a sourced file have been reported already; a failure to run the file has not.
        const bool was_reported =
            sourcing && !result && running_.size() == depth && result.error().place.file != call.place.file;
        if (was_reported) {
            return result;
        }
    }
    if (!result) {
        report(result.error());
    }
    return result;
}

std::vector<std::string> default_library() {
    std::vector<std::string> folders;
    const char *path = std::getenv("MILLWRIGHT_HALLIB");
    std::string_view rest = path == nullptr ? "" : path;
    while (!rest.empty()) {
        const std::size_t colon = rest.find(':');
        if (colon != 0) {
            folders.emplace_back(rest.substr(0, colon));
        }
        rest = colon == std::string_view::npos ? "" : rest.substr(colon + 1);
    }
    const std::string bin = program_folder();
    folders.push_back(bin + "/../share/hallib");
    folders.push_back(bin + "/../share/millwright/hallib");
    return folders;
}

}  // namespace mw::hal::script
