// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_file.hh"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/atomic_file.hh"
#include "base/diagnostics/message_limit.hh"
#include "base/ini/ini_escape.hh"
#include "base/ini/ini_strict.hh"
#include "base/text.hh"

namespace mw::ini {
namespace {

constexpr int MAX_INCLUDE_DEPTH = 16;
constexpr std::size_t LONGEST_LINE = 65536;  // including its continuation lines [bytes]

std::string folder_of(const std::string &path) {
    const auto slash = path.rfind('/');
    if (slash == std::string::npos) {
        return ".";
    }
    return slash == 0 ? "/" : path.substr(0, slash);
}

/// Pipes and devices may never end, so only regular files are read.
Result<std::string> read_settings(const std::string &path) {
    constexpr std::size_t LONGEST = 64U << 20U;
    return read_file(path, LONGEST);
}

/// Why a file cannot be read, in the words of LinuxCNC's inivalue, which scripts compare.
std::string unreadable(const std::string &path, const Error &error) {
    if (::access(path.c_str(), R_OK) == 0) {
        return error.message;  // the file exists but is not a file of settings
    }
    const int cause = errno;
    return fmt::format("Cannot open ini-file (errno={} ({}))", cause, std::generic_category().message(cause));
}

std::string expand_home(std::string_view name) {
    const char *home = std::getenv("HOME");
    if (home != nullptr && (name == "~" || name.substr(0, 2) == "~/")) {
        return home + std::string(name.substr(1));
    }
    return std::string(name);
}

}  // namespace

/// Reads lines into an IniFile; one instance for a file and its includes.
class IniParser {
  public:
    IniParser(IniFile &file, diagnostics::Sink &sink, IniSyntax syntax)
        : file_(file), sink_(sink), strict_(syntax == IniSyntax::STRICT), told_(sink.all().size()) {}

    void text(std::string_view text, const std::string &path, int depth) {
        int line = 0;
        text = without_byte_order_mark(text);
        open_.push_back(path);
        while (!text.empty() && !stopped_) {
            ++line;
            const int first_line = line;
            std::string joined = take_line(text);
            while (!joined.empty() && joined.back() == '\\' && !text.empty()) {
                joined.pop_back();
                joined += take_line(text);
                ++line;
            }
            one_line(joined, {path, first_line, 1}, depth);
        }
        open_.pop_back();
    }

  private:
    static std::string take_line(std::string_view &text) {
        const auto end = text.find('\n');
        std::string line(text.substr(0, end));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        if (!line.empty() && line.back() == '\r') {
            line.pop_back();
        }
        return line;
    }

    /// Strict reading ends at the first error.
    void stop(std::string message, const SourcePlace &place) {
        sink_.error(std::move(message), place);
        stopped_ = true;
    }

    void one_line(const std::string &line, SourcePlace place, int depth) {
        const std::string_view body = trim(line);
        place.column = body.empty() ? 1 : static_cast<int>(body.data() - line.data()) + 1;
        if (body.substr(0, 8) == "#INCLUDE") {
            include(trim(body.substr(8)), place, depth);
        } else if (body.empty() || body[0] == '#' || body[0] == ';') {
            return;
        } else if (line.size() > LONGEST_LINE) {
            too_long(place);
        } else if (body[0] == '[') {
            section(body, place);
        } else {
            entry(line, body, place);
        }
        if (!stopped_ && sink_.all().size() - told_ >= diagnostics::MOST_OF_A_FILE) {
            stop("too many errors: the rest of the file is not read", place);
        }
    }

    void too_long(const SourcePlace &place) {
        const std::string message = fmt::format("a line has more than {} characters", LONGEST_LINE);
        if (strict_) {
            stop(message, place);
        } else {
            sink_.error(message, place);
        }
    }

    void section(std::string_view body, const SourcePlace &place) {
        if (const auto fault = strict_ ? fault_of_header(body) : std::nullopt) {
            stop(*fault, place);
            return;
        }
        const auto end = body.find(']');
        const std::string_view name = end == std::string_view::npos ? "" : trim(body.substr(1, end - 1));
        const std::string_view rest = end == std::string_view::npos ? "" : trim(body.substr(end + 1));
        const bool is_comment_after = rest.empty() || rest[0] == '#' || rest[0] == ';';
        if (strict_) {
            strict_section(std::string(name), !is_comment_after, place);
            return;
        }
        if (name.empty() || !is_comment_after) {
            sink_.error("malformed section header '" + std::string(body) + "'", place, "expected [SECTION]");
            section_.clear();
            in_bad_section_ = true;
            return;
        }
        section_ = name;
        in_bad_section_ = false;
        file_.add_section(section_, place);
    }

    void strict_section(const std::string &name, bool has_more, const SourcePlace &place) {
        if (has_more) {
            sink_.warning("Section header has trailing content, ignored", place);
        }
        section_ = name;
        if (file_.hasSection(name)) {
            sink_.warning("Section '" + name + "' already exists. Merging...", place);
        }
        file_.add_section(name, place);
    }

    void strict_entry(std::string_view body, const SourcePlace &place) {
        if (const auto fault = fault_of_setting(body)) {
            stop(*fault, place);
            return;
        }
        const auto equals = body.find('=');
        const std::string key(trim(body.substr(0, equals)));
        if (section_.empty()) {
            stop("Tag '" + key + "' found without prior section definition", place);
            return;
        }
        const auto value = decode_ini_value(trim(body.substr(equals + 1)));
        if (!value) {
            stop(value.error().message, place);
            return;
        }
        file_.add_entry({section_, key, *value, place});
    }

    void entry(const std::string &line, std::string_view body, SourcePlace place) {
        if (strict_ && line.back() == '\\') {
            stop("Last line has a continuation", place);
            return;
        }
        if (strict_) {
            strict_entry(body, place);
            return;
        }
        const auto equals = body.find('=');
        const std::string_view key = equals == std::string_view::npos ? "" : trim(body.substr(0, equals));
        const bool is_one_word = equals == std::string_view::npos && body.find_first_of(" \t") == body.npos;
        if (is_one_word) {
            // A setting needs a value, so the warning loses nothing.
            sink_.warning("'" + std::string(body) + "' is not a KEY = VALUE line; it has no effect", place,
                          "expected KEY = VALUE, [SECTION], or a comment that starts with # or ;");
            return;
        }
        if (key.empty()) {
            sink_.error("malformed line '" + std::string(body) + "'", place,
                        "expected KEY = VALUE, [SECTION], or a comment that starts with # or ;");
            return;
        }
        if (section_.empty()) {
            if (!in_bad_section_ && !file_.early_key_) {
                file_.early_key_ = IniEntry{"", std::string(key), "", place};
            }
            if (!in_bad_section_) {
                sink_.error("'" + std::string(key) + "' is before the first [SECTION]", place);
            }
            return;
        }
        const std::string_view value = trim(body.substr(equals + 1));
        place.column =
            static_cast<int>((value.empty() ? body.data() + equals + 1 : value.data()) - line.data()) + 1;
        file_.add_entry({section_, std::string(key), std::string(value), place});
    }

    void include(std::string_view name, const SourcePlace &place, int depth) {
        if (name.empty() && strict_) {
            stop("Missing filename after #INCLUDE", place);
            return;
        }
        if (name.empty()) {
            sink_.warning("#INCLUDE without a file name; it has no effect", place);
            return;
        }
        if (depth >= MAX_INCLUDE_DEPTH) {
            sink_.error("#INCLUDE nested deeper than " + std::to_string(MAX_INCLUDE_DEPTH) + " files", place);
            return;
        }
        std::string path = expand_home(name);
        if (path.front() != '/') {
            const bool here = place.file.find('/') == std::string::npos;
            const std::string beside = here ? path : folder_of(place.file) + '/' + path;
            path = ::access(beside.c_str(), R_OK) == 0 ? beside : path;
        }
        if (strict_ && isOpen(path)) {
            stop("Include file recursion on loading '" + path + "'", place);
            return;
        }
        const auto content = read_settings(path);
        if (!content.has_value() && strict_) {
            stop(unreadable(path, content.error()), {path, 0, 0});
            return;
        }
        if (!content.has_value()) {
            sink_.error("#INCLUDE: " + content.error().message, place);
            return;
        }
        text(*content, path, depth + 1);
    }

    bool isOpen(const std::string &path) const {
        std::error_code error;
        return std::any_of(open_.begin(), open_.end(), [&](const std::string &one) {
            return one == path || std::filesystem::equivalent(one, path, error);
        });
    }

    IniFile &file_;
    diagnostics::Sink &sink_;
    bool strict_;
    std::size_t told_;  ///< number of messages of earlier files
    bool stopped_ = false;
    std::vector<std::string> open_{};  ///< the file being read, preceded by the files that include it
    std::string section_;
    bool in_bad_section_ = false;
};

Result<IniFile> IniFile::load(const std::string &path, diagnostics::Sink &sink, IniSyntax syntax) {
    const auto content = read_settings(path);
    if (!content.has_value() && syntax == IniSyntax::STRICT) {
        return fail(unreadable(path, content.error()));
    }
    if (!content.has_value()) {
        return std::unexpected(content.error());
    }
    return parse(*content, path, sink, syntax);
}

IniFile IniFile::parse(std::string_view text, const std::string &path, diagnostics::Sink &sink,
                       IniSyntax syntax) {
    IniFile file;
    file.path_ = path;
    IniParser(file, sink, syntax).text(text, path, 0);
    return file;
}

std::string IniFile::folder() const {
    return folder_of(path_);
}

std::string IniFile::resolve_path(std::string_view name) const {
    std::string expanded = expand_home(name);
    if (!expanded.empty() && expanded.front() == '/') {
        return expanded;
    }
    return folder() + '/' + expanded;
}

void IniFile::add_section(const std::string &name, const SourcePlace &place) {
    if (sections_.try_emplace(name, Section{place}).second) {
        section_names_.push_back(name);
    }
}

void IniFile::add_entry(IniEntry entry) {
    Section &section = sections_.find(entry.section)->second;
    std::vector<std::size_t> &all = section.by_key[entry.key];
    if (all.empty()) {
        section.keys.push_back(entry.key);
    }
    all.push_back(entries_.size());
    entries_.push_back(std::move(entry));
}

const std::vector<std::size_t> *IniFile::indices(std::string_view section, std::string_view key) const {
    const auto found = sections_.find(section);
    if (found == sections_.end()) {
        return nullptr;
    }
    const auto entries = found->second.by_key.find(key);
    return entries == found->second.by_key.end() ? nullptr : &entries->second;
}

bool IniFile::hasSection(std::string_view section) const {
    return sections_.contains(section);
}

const IniEntry *IniFile::find(std::string_view section, std::string_view key, int number) const {
    const std::vector<std::size_t> *const all = indices(section, key);
    const bool present = all != nullptr && number >= 1 && static_cast<std::size_t>(number) <= all->size();
    return present ? &entries_[(*all)[static_cast<std::size_t>(number - 1)]] : nullptr;
}

std::vector<const IniEntry *> IniFile::find_all(std::string_view section, std::string_view key) const {
    std::vector<const IniEntry *> found;
    if (const std::vector<std::size_t> *const all = indices(section, key)) {
        for (const std::size_t index : *all) {
            found.push_back(&entries_[index]);
        }
    }
    return found;
}

std::vector<std::string> IniFile::sections() const {
    return section_names_;
}

std::vector<std::string> IniFile::keys(std::string_view section) const {
    const auto found = sections_.find(section);
    return found == sections_.end() ? std::vector<std::string>() : found->second.keys;
}

SourcePlace IniFile::place_of_section(std::string_view section) const {
    const auto found = sections_.find(section);
    return found == sections_.end() ? SourcePlace{path_, 0, 0} : found->second.place;
}

}  // namespace mw::ini
