// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/format.hh"

#include <vector>

#include "gcode/syntax/parser.hh"
#include "gcode/syntax/printer.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

using detail::OKind;

constexpr std::size_t INDENT = 4;

class Formatter {
  public:
    std::string line(std::string_view line) {
        arena_.clear();
        const detail::Block block = detail::Parser(arena_, names_).parse_line(line, 1);
        const std::string_view bare = line.substr(0, line.find_last_not_of(" \t\r") + 1);
        if (block.error != detail::NO_ID || block.is_percent) {
            return std::string(bare);
        }
        const std::string text = detail::Printer(arena_, line).block(block);
        if (block.oword == detail::NO_ID) {
            return indented(text, open_.size());
        }
        const detail::OWord &oword = arena_.owords[block.oword];
        leave(oword);
        const bool between = oword.kind == OKind::ELSE || oword.kind == OKind::ELSEIF;
        const std::string out = indented(text, between && !open_.empty() ? open_.size() - 1 : open_.size());
        enter(oword);
        return out;
    }

  private:
    struct Open {
        OKind kind;
        detail::NameId label;
    };

    static std::string indented(const std::string &text, std::size_t level) {
        return text.empty() ? text : std::string(level * INDENT, ' ') + text;
    }
    /// A `while` that ends a `do` closes its loop; any other `while` opens a loop.
    bool endsDo(const detail::OWord &oword) const {
        return oword.kind == OKind::WHILE && !open_.empty() && open_.back().kind == OKind::DO &&
               open_.back().label == oword.label;
    }
    void leave(const detail::OWord &oword) {
        switch (oword.kind) {
        case OKind::ENDSUB:
        case OKind::ENDIF:
        case OKind::ENDWHILE:
        case OKind::ENDREPEAT: pop(); break;
        case OKind::WHILE:
            was_do_ = endsDo(oword);
            if (was_do_) {
                pop();
            }
            break;
        default: break;
        }
    }
    void enter(const detail::OWord &oword) {
        switch (oword.kind) {
        case OKind::SUB:
        case OKind::IF:
        case OKind::DO:
        case OKind::REPEAT: open_.push_back({oword.kind, oword.label}); break;
        case OKind::WHILE:
            if (!was_do_) {
                open_.push_back({oword.kind, oword.label});
            }
            break;
        default: break;
        }
    }
    void pop() {
        if (!open_.empty()) {
            open_.pop_back();
        }
    }

    detail::Names names_;
    detail::Arena arena_;
    std::vector<Open> open_;
    bool was_do_ = false;
};

}  // namespace

std::string format_program(std::string_view text) {
    Formatter formatter;
    std::string out;
    out.reserve(text.size() + text.size() / 4);
    while (!text.empty()) {
        const std::size_t newline = text.find('\n');
        out += formatter.line(text.substr(0, newline));
        if (newline == std::string_view::npos) {
            break;
        }
        out += '\n';
        text.remove_prefix(newline + 1);
    }
    return out;
}

}  // namespace mw::gcode
