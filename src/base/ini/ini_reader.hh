// SPDX-License-Identifier: GPL-2.0-or-later
// Typed reads of an INI file after the declarations of its keys; unknown keys are found at the end.
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

/// Reads keys and remembers which ones the system knows. Every problem is one message to the sink, with file,
/// line and column; the value returned then is the default, so that reading goes on and reports them all.
class IniReader {
  public:
    IniReader(const IniFile &file, diagnostics::Sink &sink)
        : file_(file), target_(&sink),
          sink_([this](const diagnostics::Diagnostic &one) { target_->report(with_comment_hint(one)); }) {}
    IniReader(const IniReader &) = delete;
    IniReader &operator=(const IniReader &) = delete;

    const IniFile &file() const { return file_; }
    /// For problems of this file: one in a line with a comment after the value gets a hint about it.
    diagnostics::Sink &sink() { return sink_; }
    /// From now on problems go there.
    void tell(diagnostics::Sink &sink) { target_ = &sink; }

    /// Makes the keys of a table known. Rows of "JOINT_*" and the like count with declare_in().
    void declare(std::span<const IniKey> keys);
    /// The rows whose section is `pattern`, for one section of its kind: "JOINT_*" for JOINT_0.
    void declare_in(std::string_view section, std::string_view pattern, std::span<const IniKey> keys);

    // `section`: which one of "JOINT_*"; empty: the section of the row. Without the key the row's preset is
    // returned, or `preset` where that depends on the machine; a required key that is missing is an error.
    double real(const IniKey &key, std::string_view section = {}, std::optional<double> preset = {});
    std::int64_t integer(const IniKey &key, std::string_view section = {},
                         std::optional<std::int64_t> preset = {});
    bool boolean(const IniKey &key, std::string_view section = {});
    std::string text(const IniKey &key, std::string_view section = {});
    /// The spelling of the declaration is returned.
    std::string choice(const IniKey &key, std::string_view section = {});
    /// All entries of a key that may be given several times.
    std::vector<const IniEntry *> list(const IniKey &key, std::string_view section = {});
    /// Where it is set; null where it is not.
    const IniEntry *find(const IniKey &key, std::string_view section = {}) const;

    /// Somebody has used the key; a section that the system does not read stays not ours.
    void know_if_ours(std::string_view section, std::string_view key);
    /// A HAL file or script has used this section, whatever it is for.
    void use_section(std::string_view section) { used_sections_.insert(std::string(section)); }
    /// Says that other programs define keys of this section, so that none of them is unknown.
    void leave_open(std::string_view section);

    /// Warns once for each key in a known section that nobody declared, with the nearest known name; an error
    /// when strict. Keys that HAL files and programs use are known by that: pass them through know_if_ours()
    /// first. A declared key without effect is said with the reason.
    void report_unknown(bool isStrict);

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
    diagnostics::Sink sink_;  ///< passes on to `target_`
    std::map<std::string, std::set<std::string>, std::less<>> known_;
    std::set<std::string, std::less<>> open_;
    std::set<std::string, std::less<>> used_sections_;
    std::map<std::string, std::string> without_effect_;  ///< [SECTION]KEY: why
    std::set<std::string> warned_twice_;
    std::set<std::string> reported_;  ///< [SECTION]KEY that is unknown; never suggested for another one
    std::set<std::string> missing_sections_;
    /// File and line of values with a comment in them; empty until it is needed.
    std::optional<std::set<std::pair<std::string, int>>> commented_;
};

}  // namespace mw::ini
