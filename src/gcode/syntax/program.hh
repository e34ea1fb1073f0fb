// SPDX-License-Identifier: GPL-2.0-or-later
// One file (or one MDI line) of G-code: its text, its lines parsed on first use, and the targets of its O
// words.
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/diagnostics/sink.hh"
#include "base/result.hh"
#include "gcode/syntax/ast.hh"
#include "gcode/syntax/names.hh"
#include "gcode/syntax/program_text.hh"

namespace mw::gcode::detail {

/// A block and its arena. Valid until another line of the same program is read.
struct BlockView {
    const Block *block = nullptr;
    const Arena *arena = nullptr;
};

class Program {
  public:
    static Result<std::unique_ptr<Program>> load(const std::string &path, Names &names);
    Program(std::string path, std::string text, Names &names);

    const std::string &path() const { return path_; }
    int count_lines() const { return text_.count_lines(); }
    const ProgramText &text() const { return text_; }
    /// `line` from 1, without the newline.
    std::string_view line_text(int line) const { return text_.line(line); }
    /// Lines inside loops and subroutines are parsed once and kept; others are parsed into a scratch arena,
    /// so that memory is limited by the text and those lines. The text of a large file without O words is not
    /// kept in memory.
    BlockView block(int line);
    /// A program that begins with % ends at the next one; in any other file % is an error of its line.
    bool isPercentDelimited() const { return percent_delimited_; }
    /// False when the file begins with % and no other line does.
    bool hasClosingPercent() const;
    int first_content_line() const { return first_content_line_; }  ///< the first that is not blank; 0: none

    /// The next line after (or before) `line` with an O word of the same label; 0: none.
    int next_same(int line) const;
    int previous_same(int line) const;
    const OWord *oword_at(int line) const;
    /// Line of `O<label> sub`, or of a Fanuc-style `O<label>`; 0: none here.
    int find_sub(NameId label) const;
    int find_fanuc(NameId label) const;
    /// The first line between these two with an invalid O word, 0 when there is none.
    int find_bad_oword(int after, int before) const;
    /// The first line after `line` with an O word, 0 when there is none.
    int next_oword(int line) const;
    /// Errors of lines after `after` up to the closing percent sign, `most` at most, without running them.
    std::vector<diagnostics::Diagnostic> syntax_errors(int after, int most);

  private:
    struct OLine {
        int line = 0;
        Block block;
        int next = 0, previous = 0;
    };
    static constexpr std::uint32_t NOT_KEPT = NO_ID - 1;
    Program(std::string path, ProgramText text, Names &names);
    Result<> prepare();
    bool look_at(int line, std::string_view content);
    /// Parses a line without an O word.
    Block parse(int line, Arena &arena);
    void link_owords();
    void check_labels();
    void mark_kept();
    const OLine *find_oline(int line) const;
    static bool beginsWithO(std::string_view line);

    std::string path_;
    ProgramText text_;
    Names &names_;
    Arena arena_, scratch_;
    Block scratch_block_;
    std::vector<OLine> olines_;
    std::vector<std::uint32_t>
        cached_;  ///< indexed by line: index in blocks_, NO_ID (not parsed yet) or NOT_KEPT
    std::deque<Block> blocks_;
    std::unordered_map<NameId, int> subs_, fanuc_;
    std::vector<int> bad_olines_;  ///< in order
    bool percent_delimited_ = false;
    int first_content_line_ = 0, closing_percent_line_ = 0;
};

}  // namespace mw::gcode::detail
