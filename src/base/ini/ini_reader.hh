// SPDX-License-Identifier: GPL-2.0-or-later
// Reads typed values of an INI file by the declarations of its keys. Unknown keys are reported at the end.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/ini/ini_file.hh"
#include "base/ini/ini_key.hh"

namespace mw::ini {

/// Reads keys and records which keys are known. Each problem is one message to the sink, with file, line and
/// column. The read then returns the default, so that one start reports all problems.
class IniReader {
  public:
    IniReader(const IniFile &file, diagnostics::Sink &sink)
        : file_(file), target_(&sink),
          sink_([this](const diagnostics::Diagnostic &one) { target_->report(with_comment_hint(one)); }) {}
    IniReader(const IniReader &) = delete;
    IniReader &operator=(const IniReader &) = delete;

    const IniFile &file() const { return file_; }
    /// Sink for problems of this file. A problem in a line with a comment after the value gets a hint about
    /// the comment.
    diagnostics::Sink &sink() { return sink_; }
    /// Sends later problems to `sink`.
    void tell(diagnostics::Sink &sink) { target_ = &sink; }

    /// Makes the keys of a table known. Rows of "JOINT_*" and similar sections need declare_in().
    void declare(std::span<const IniKey> keys);
    /// Makes the rows of section `pattern` known for one section: "JOINT_*" for JOINT_0.
    void declare_in(std::string_view section, std::string_view pattern, std::span<const IniKey> keys);

    // `section`: the section for a row of "JOINT_*"; empty: the section of the row. If the key is not set,
    // returns the row's default, or `preset` where that depends on the machine. A required key that is
    // missing is an error.
    double real(const IniKey &key, std::string_view section = {}, std::optional<double> preset = {});
    std::int64_t integer(const IniKey &key, std::string_view section = {},
                         std::optional<std::int64_t> preset = {});
    bool boolean(const IniKey &key, std::string_view section = {});
    std::string text(const IniKey &key, std::string_view section = {});
    /// Returns the word as spelled in the declaration.
    std::string choice(const IniKey &key, std::string_view section = {});
    /// All entries of a key that may be set several times.
    std::vector<const IniEntry *> list(const IniKey &key, std::string_view section = {});
    /// The entry; null if the key is not set.
    const IniEntry *find(const IniKey &key, std::string_view section = {}) const;

    /// Marks a key as used by a program. Does not make an unknown section known.
    void know_if_ours(std::string_view section, std::string_view key);
    /// Marks the section as used by a HAL file or script.
    void use_section(std::string_view section) { used_sections_.insert(std::string(section)); }
    /// Declares that other programs define keys of this section, so that no key of it is reported as unknown.
    void leave_open(std::string_view section);

    /// Warns once for each unknown key in a known section and names the nearest known key; an error when
    /// strict. Pass keys that HAL files and programs use through know_if_ours() first. Reports a declared key
    /// without effect with the reason.
    void report_unknown(bool strict);

  private:
    void know(std::string_view section, std::string_view key);
    void declare_row(std::string_view section, const IniKey &key);
    const IniEntry *scalar(const IniKey &key, std::string_view section);
    void missing(std::string_view section, const IniKey &key, const std::string &expected);
    void report_sections(diagnostics::Severity severity);
    std::optional<double> number(const IniEntry &entry, const IniKey &key);
    std::optional<std::int64_t> whole(const IniEntry &entry, const IniKey &key);

    diagnostics::Diagnostic with_comment_hint(diagnostics::Diagnostic one);

    const IniFile &file_;
    diagnostics::Sink *target_;
    diagnostics::Sink sink_;  ///< forwards to `target_`
    std::map<std::string, std::set<std::string>, std::less<>> known_;
    std::set<std::string, std::less<>> open_;
    std::set<std::string, std::less<>> used_sections_;
    std::map<std::string, std::string> without_effect_;  ///< [SECTION]KEY: reason
    std::set<std::string> warned_twice_;
    std::set<std::string> reported_;  ///< unknown [SECTION]KEY; not suggested for another key
    std::set<std::string> missing_sections_;
    /// File and line of values that contain a comment; filled when first needed.
    std::optional<std::set<std::pair<std::string, int>>> commented_;
};

}  // namespace mw::ini
