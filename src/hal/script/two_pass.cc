// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/script/two_pass.hh"

#include <algorithm>
#include <sstream>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/text.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

std::vector<std::string> split_list(const std::string &text) {
    std::vector<std::string> items;
    std::size_t start = 0;
    while (start <= text.size() && !text.empty()) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        items.push_back(text.substr(start, comma - start));
        start = comma + 1;
    }
    return items;
}

std::string joined(const std::vector<std::string> &items) {
    std::string text;
    for (const std::string &item : items) {
        text += (text.empty() ? "" : ",") + item;
    }
    return text;
}

/// True for a line such as "# NOTWOPASS".
bool isExclusion(const std::string &line) {
    std::string text;
    for (const char c : line) {
        if (c != ' ' && c != '\t' && c != '\r') {
            text += c;
        }
    }
    return to_lower(text).starts_with("#notwopass");
}

bool isExcluded(const std::string &path) {
    std::istringstream file(read_file(path).value_or(""));
    std::string line;
    while (std::getline(file, line)) {
        if (isExclusion(line)) {
            return true;
        }
    }
    return false;
}

/// A path in the form of twopass messages.
std::string shown(const std::string &path) {
    return path.find('/') == std::string::npos ? "./" + path : path;
}

}  // namespace

std::vector<std::string> MergedLoads::Load::words() const {
    std::vector<std::string> words = {"loadrt", module};
    if (!names.empty()) {
        words.push_back("names=" + joined(names));
    }
    if (!count_word.empty()) {
        words.push_back(fmt::format("{}={}", count_word, count));
    }
    const bool has_personality =
        std::any_of(personalities.begin(), personalities.end(),
                    [](const std::string &personality) { return !personality.empty(); });
    if (has_personality) {
        std::vector<std::string> all = personalities;
        std::replace(all.begin(), all.end(), std::string(), std::string("0"));
        words.push_back("personality=" + joined(all));
    }
    for (const Parameter &other : others) {
        words.push_back(other.name.empty() ? other.value : other.name + "=" + other.value);
    }
    return words;
}

Result<> MergedLoads::add(const Call &loadrt) {
    const std::string &module = loadrt.text(0);
    auto found =
        std::find_if(loads_.begin(), loads_.end(), [&](const Load &load) { return load.module == module; });
    if (found == loads_.end()) {
        loads_.push_back({});
        found = loads_.end() - 1;
        found->module = module;
        found->place = loadrt.place;
    }
    Load &load = *found;
    const std::size_t instances_before = load.names.size() + static_cast<std::size_t>(load.count);
    std::vector<std::string> personalities;
    for (std::size_t i = 1; i < loadrt.words.size(); ++i) {
        const std::string &word = loadrt.text(i);
        const std::size_t equals = word.find('=');
        Parameter parameter{equals == std::string::npos ? "" : word.substr(0, equals),
                            equals == std::string::npos ? word : word.substr(equals + 1), loadrt.place_of(i)};
        Result<> added;
        if (parameter.name == "names") {
            added = add_names(load, parameter);
        } else if (parameter.name == "count" || parameter.name == "num_chan") {
            added = add_count(load, parameter);
        } else if (parameter.name == "personality") {
            personalities = split_list(parameter.value);
        } else {
            added = add_other(load, parameter);
        }
        if (!added) {
            return added;
        }
    }
    // Personalities belong to the instances of the same line.
    const std::size_t instances = load.names.size() + static_cast<std::size_t>(load.count);
    const std::size_t own = std::max(instances - instances_before, personalities.size());
    personalities.resize(own);
    load.personalities.insert(load.personalities.end(), personalities.begin(), personalities.end());
    return {};
}

Result<> MergedLoads::add_names(Load &load, const Parameter &parameter) {
    if (!load.count_word.empty()) {
        return fail(fmt::format("module '{}' is loaded with {}= elsewhere: it cannot have names= too",
                                load.module, load.count_word),
                    parameter.place);
    }
    for (const std::string &name : split_list(parameter.value)) {
        const auto same = std::find(load.names.begin(), load.names.end(), name);
        if (same != load.names.end()) {
            const SourcePlace &first = load.name_places[static_cast<std::size_t>(same - load.names.begin())];
            return fail(fmt::format("module '{}' has the name '{}' twice, first at {}", load.module, name,
                                    first.str()),
                        parameter.place);
        }
        load.names.push_back(name);
        load.name_places.push_back(parameter.place);
    }
    return {};
}

Result<> MergedLoads::add_count(Load &load, const Parameter &parameter) {
    const bool mixed = !load.names.empty() || (!load.count_word.empty() && load.count_word != parameter.name);
    if (mixed) {
        return fail(fmt::format("module '{}' is loaded with {}= elsewhere: it cannot have {}= too",
                                load.module, load.names.empty() ? load.count_word : "names", parameter.name),
                    parameter.place);
    }
    constexpr std::int64_t HIGHEST = 10000;
    const auto count = parse_c_int(parameter.value);
    if (!count || *count < 0 || *count > HIGHEST) {
        return fail(fmt::format("'{}' is not a number of instances", parameter.value), parameter.place,
                    fmt::format("{}=2, for example", parameter.name));
    }
    load.count_word = parameter.name;
    load.count += *count;
    return {};
}

Result<> MergedLoads::add_other(Load &load, const Parameter &parameter) {
    for (const Parameter &other : load.others) {
        if (other.name != parameter.name) {
            continue;
        }
        if (other.value == parameter.value) {
            return {};
        }
        return fail(fmt::format("module '{}' has {}={} here and {}={} at {}", load.module, parameter.name,
                                parameter.value, other.name, other.value, other.place.str()),
                    parameter.place,
                    "several lines for one module are merged; this parameter can have one value");
    }
    load.others.push_back(parameter);
    return {};
}

namespace {

/// Implementation of run_two_pass.
class TwoPass final : private LoadCollector {
  public:
    TwoPass(Session &session, const std::vector<HalFileEntry> &files, TwoPassReport report)
        : session_(session), entries_(files), report_(report), before_(session.options()) {}

    ~TwoPass() override {
        session_.options().pass = before_.pass;
        session_.options().loads = before_.loads;
    }

    Result<> run() {
        Result<> result = find_files();
        step("pass0:BEGIN");
        result = result ? collect() : result;
        result = result ? load() : result;
        step("pass0:END");
        if (!result) {
            return result;
        }
        step("pass1:BEGIN");
        session_.options().pass = Pass::REST;
        Result<> first;
        for (const File &file : files_) {
            if (file.excluded) {
                continue;
            }
            step("sourcing: " + file.shown);
            const Result<> done = session_.run_file(file.path, file.arguments);
            first = first ? done : first;
            if (!done && !session_.options().keepsGoing) {
                return first;
            }
        }
        step("pass1:END");
        return first;
    }

  private:
    struct File {
        std::string path;
        std::string shown;
        std::vector<std::string> arguments;
        bool excluded = false;
        std::size_t modules_before = 0;  ///< number of modules that earlier files load
    };

    Result<> add(const Call &loadrt) override { return loads_.add(loadrt); }
    void starting(const Call &loadusr) override {
        std::string text = "pass0: loadusr";
        for (const Word &word : loadusr.words) {
            text += " " + word.raw;
        }
        if (report_ != TwoPassReport::NOTHING) {
            say(text);
        }
    }
    void say(const std::string &text) { session_.output().data("twopass:" + text + "\n"); }
    void step(const std::string &text) {
        if (report_ == TwoPassReport::VERBOSE) {
            say(" " + text);
        }
    }
    Result<> failed(const Error &error) {
        session_.output().error(error);
        return std::unexpected(error);
    }

    Result<> find_files() {
        for (const HalFileEntry &entry : entries_) {
            std::vector<std::string> words = mw::split_words(entry.text);
            if (words.empty()) {
                return failed(Error{"[HAL]HALFILE names no file", entry.place, {}});
            }
            const Result<std::string> path = session_.find_file(words[0]);
            if (!path) {
                return failed(at(std::unexpected(path.error()), entry.place).error());
            }
            File file;
            file.path = *path;
            file.shown = shown(*path);
            file.arguments.assign(words.begin() + 1, words.end());
            if (report_ != TwoPassReport::NOTHING) {
                say("found " + file.shown);
            }
            file.excluded = !path->ends_with(".tcl") && isExcluded(*path);
            if (file.excluded && report_ != TwoPassReport::NOTHING) {
                say("Sourcing " + file.shown + " WITHOUT twopass processing");
            }
            files_.push_back(std::move(file));
        }
        return {};
    }

    Result<> collect() {
        session_.options().pass = Pass::LOADS;
        session_.options().loads = this;
        for (File &file : files_) {
            file.modules_before = loads_.loads().size();
            if (file.excluded) {
                continue;
            }
            step("sourcing: " + file.shown);
            const Result<> done = session_.run_file(file.path, file.arguments);
            if (!done) {
                return done;
            }
        }
        return {};
    }

    /// Loads the modules in the order of their first lines, and runs excluded files in between.
    Result<> load() {
        session_.options().pass = Pass::ALL;
        std::size_t next = 0;
        for (const File &file : files_) {
            if (!file.excluded) {
                continue;
            }
            const Result<> loaded = load_modules(next, file.modules_before);
            if (!loaded) {
                return loaded;
            }
            next = file.modules_before;
            run_excluded(file);
        }
        return load_modules(next, loads_.loads().size());
    }

    Result<> load_modules(std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const MergedLoads::Load &load = loads_.loads()[i];
            const std::vector<std::string> words = load.words();
            std::string text;
            for (const std::string &word : words) {
                text += (text.empty() ? "" : " ") + word;
            }
            step(text);
            const Result<std::string> loaded = session_.call(words);
            if (!loaded) {
                Error error = loaded.error();
                error.place = load.place;
                error.message = fmt::format("{} (all lines together: {})", error.message, text);
                return failed(error);
            }
        }
        return {};
    }

    /// Runs an excluded file as halcmd with options -k and -v: failures are reported and do not stop it.
    void run_excluded(const File &file) {
        const Verbosity verbosity = session_.options().verbosity;
        const bool keepsGoing = session_.options().keepsGoing;
        session_.options().verbosity = std::max(verbosity, Verbosity::RESULTS);
        session_.options().keepsGoing = true;
        (void)session_.run_file(file.path);
        session_.options().verbosity = verbosity;
        session_.options().keepsGoing = keepsGoing;
    }

    Session &session_;
    const std::vector<HalFileEntry> &entries_;
    TwoPassReport report_;
    SessionOptions before_;
    MergedLoads loads_;
    std::vector<File> files_;
};

}  // namespace

Result<> run_two_pass(Session &session, const std::vector<HalFileEntry> &files, const std::string &keywords,
                      TwoPassReport report) {
    const std::string lower = to_lower(keywords);
    const bool verbose = lower.find("verbose") != std::string::npos;
    if (report != TwoPassReport::NOTHING) {
        // The two keywords that have an effect.
        const bool keepsFiles = lower.find("nodelete") != std::string::npos;
        session.output().data(fmt::format("twopass:invoked with <{}{}{}> options\n", verbose ? "verbose" : "",
                                          verbose && keepsFiles ? " " : "", keepsFiles ? "nodelete" : ""));
    }
    return TwoPass(session, files, verbose ? TwoPassReport::VERBOSE : report).run();
}

}  // namespace mw::hal::script
