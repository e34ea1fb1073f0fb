// SPDX-License-Identifier: GPL-2.0-or-later
// An INI file with the position of each entry. Syntax: LinuxCNC Integrator Manual, "INI Configuration"
// (format facts).
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"

namespace mw::ini {

struct IniEntry {
    std::string section;
    std::string key;
    std::string value;  ///< trimmed; ';' and '#' in a value belong to the value
    SourcePlace place;  ///< position of the value's first character
};

/// TOLERANT reads the file of a machine: all problems are reported, values are not changed. STRICT stops at
/// the first error, also in the name of a key, an escape or a missing include. It replaces escapes and uses
/// the messages of inivalue, which scripts know.
enum class IniSyntax { TOLERANT, STRICT };

/// Sections and keys keep their order and their case; a key may occur several times (then it is a list).
/// `#INCLUDE file` inserts another file, found beside the including one, in the working folder, or by '~'.
class IniFile {
  public:
    /// Reads `path`. Reports each malformed line to `sink`. Fails only when the file itself cannot be read.
    static Result<IniFile> load(const std::string &path, diagnostics::Sink &sink,
                                IniSyntax syntax = IniSyntax::TOLERANT);
    /// Reads text in memory; `path` names it in messages and is the base of includes.
    static IniFile parse(std::string_view text, const std::string &path, diagnostics::Sink &sink,
                         IniSyntax syntax = IniSyntax::TOLERANT);

    const std::string &path() const { return path_; }
    /// The folder of the path as given (symbolic links are not resolved), "." when it has none.
    std::string folder() const;
    /// `name` relative to the folder of the INI file. Absolute names and '~' are not changed.
    std::string resolve_path(std::string_view name) const;

    /// The first setting before any section.
    const std::optional<IniEntry> &early_key() const { return early_key_; }
    bool hasSection(std::string_view section) const;
    /// The `number`-th entry (from 1) of that key, or nullptr.
    const IniEntry *find(std::string_view section, std::string_view key, int number = 1) const;
    std::vector<const IniEntry *> find_all(std::string_view section, std::string_view key) const;
    const std::vector<IniEntry> &entries() const { return entries_; }
    std::vector<std::string> sections() const;
    std::vector<std::string> keys(std::string_view section) const;
    /// Position of the section header; only the file when there is no such section.
    SourcePlace place_of_section(std::string_view section) const;

  private:
    struct Section {
        SourcePlace place;
        std::vector<std::string> keys{};  ///< each once, in the order of the file
        /// Indices in entries_ of each key.
        std::map<std::string, std::vector<std::size_t>, std::less<>> by_key{};
    };
    friend class IniParser;

    /// place_of_section() returns the first header.
    void add_section(const std::string &name, const SourcePlace &place);
    /// The section must have been added.
    void add_entry(IniEntry entry);
    const std::vector<std::size_t> *indices(std::string_view section, std::string_view key) const;

    std::string path_;
    std::vector<std::string> section_names_;  ///< in the order of the file
    std::map<std::string, Section, std::less<>> sections_;
    std::optional<IniEntry> early_key_;
    std::vector<IniEntry> entries_;
};

}  // namespace mw::ini
