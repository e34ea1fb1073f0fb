// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/analysis/explain.hh"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "base/text.hh"
#include "gcode/canon/quiet_canon.hh"
#include "gcode/interpreter/codes/codes.hh"
#include "gcode/interpreter/interpreter.hh"
#include "gcode/interpreter/standalone.hh"
#include "gcode/syntax/parser.hh"
#include "gcode/syntax/printer.hh"

namespace mw::gcode {
namespace {

using namespace gcode;

using detail::OKind;

/// Indices in ActiveCodes.
enum Place : std::size_t { MOTION = 1, UNITS = 5, DISTANCE = 6, FEED_MODE = 7, SPINDLE_MODE = 13 };
constexpr int INCHES = number_of(G(20)), INCREMENTAL = number_of(G(91)), INVERSE_TIME = number_of(G(93)),
              PER_REVOLUTION = number_of(G(95)), SURFACE_SPEED = number_of(G(96));

/// An interpreter without a machine.
class Bench {
  public:
    Bench() : interpreter_(canon_, world_, world_, world_, settings()) {
        world_.table = built_in_tools();
        world_.units = LengthUnits::MM;
    }
    /// Runs lines; false after an error.
    bool run(std::string_view lines) {
        if (!started_) {
            started_ = interpreter_.begin().has_value();
        }
        while (!lines.empty()) {
            const std::size_t end = std::min(lines.find('\n'), lines.size());
            Step step = interpreter_.execute(lines.substr(0, end));
            while (step == Step::OK || step == Step::SYNC) {
                step = interpreter_.step();
            }
            if (step == Step::FAILED) {
                return false;
            }
            lines.remove_prefix(std::min(end + 1, lines.size()));
        }
        return true;
    }
    const diagnostics::Diagnostic &error() const { return interpreter_.error(); }
    ActiveCodes codes() const { return interpreter_.active_codes(); }
    double parameter(int number) const { return interpreter_.parameter(number); }

  private:
    static Settings settings() {
        constexpr std::uint64_t BUDGET = 1000000;
        Settings out;
        out.user_code_assumed = true;
        out.statement_budget = BUDGET;
        return out;
    }
    QuietCanon canon_;
    Standalone world_;
    Interpreter interpreter_;
    bool started_ = false;
};

std::string_view oword_text(OKind kind) {
    switch (kind) {
    case OKind::SUB: return "the subroutine begins here";
    case OKind::ENDSUB: return "the subroutine ends here; a value in brackets becomes #<_value>";
    case OKind::CALL: return "calls the subroutine; values in brackets become its #1, #2 and so on";
    case OKind::RETURN: return "leaves the subroutine; a value in brackets becomes #<_value>";
    case OKind::IF: return "continues after this line when the value is not 0, else at elseif, else or endif";
    case OKind::ELSEIF: return "the next condition, when none before was true";
    case OKind::ELSE: return "what runs when no condition was true";
    case OKind::ENDIF: return "the condition ends here";
    case OKind::WHILE: return "repeats the lines to endwhile, or those from do, while the value is not 0";
    case OKind::ENDWHILE: return "the loop ends here";
    case OKind::DO: return "the loop begins here; a while of the same label ends it";
    case OKind::REPEAT: return "repeats the lines to endrepeat so many times";
    case OKind::ENDREPEAT: return "the loop ends here";
    case OKind::BREAK: return "leaves the loop";
    case OKind::CONTINUE: return "continues with the next iteration of the loop";
    case OKind::FANUC:
    case OKind::NONE: break;
    }
    return "a subroutine of Fanuc style begins here; M98 P calls it, M99 ends it";
}

std::string_view comment_text(std::string_view comment) {
    struct Kind {
        std::string_view begin, text;
    };
    constexpr Kind KINDS[] = {{"msg,", "a message to the operator"},
                              {"debug,", "a message to the operator, with values of parameters"},
                              {"print,", "a line to standard output, with values of parameters"},
                              {"log,", "a line to the log file, with values of parameters"},
                              {"logopen,", "begins a log file"},
                              {"logappend,", "opens a log file to write on"},
                              {"logclose", "closes the log file"},
                              {"probeopen", "begins a file of probed points"},
                              {"probeclose", "closes the file of probed points"},
                              {"abort,", "an error of the program itself"},
                              {"section,", "names the section that begins, for time estimates"},
                              {"py,", "a Python statement"}};
    const std::string text = to_lower(trim(comment));
    for (const Kind &kind : KINDS) {
        if (text.substr(0, kind.begin.size()) == kind.begin) {
            return kind.text;
        }
    }
    return "a comment";
}

class Explainer {
  public:
    Explainer(std::string_view line, std::string_view before) : line_(line), before_(before) {}

    Explanation run() {
        if (!bench_.run(before_)) {
            return refused("before the line: ", bench_.error());
        }
        block_ = detail::Parser(arena_, names_).parse_line(line_, 1);
        codes_ = bench_.codes();
        const bool done = hasOword() || bench_.run(line_);
        if (done && !hasOword()) {
            codes_ = bench_.codes();
        }
        if (block_.error != detail::NO_ID) {
            const detail::SyntaxError &error = arena_.errors[block_.error];
            return refused("", {diagnostics::Severity::ERROR,
                                {error.message, {"line", 1, static_cast<int>(error.column)}, {}},
                                {},
                                std::string(line_)});
        }
        Explanation out;
        out.text =
            std::string(block_.is_percent ? trim(line_) : detail::Printer(arena_, line_).block(block_)) +
            "\n";
        out.text += parts();
        if (!done) {
            const Explanation why = refused("", bench_.error());
            return {out.text + why.text, true};
        }
        out.text += modes();
        return out;
    }

  private:
    bool hasOword() const { return block_.oword != detail::NO_ID; }
    static Explanation refused(const std::string &where, const diagnostics::Diagnostic &error) {
        return {"refused: " + where + error.str() + "\n", true};
    }
    std::string length_unit() const { return codes_.g[UNITS] == INCHES ? "inch" : "mm"; }

    std::string row(const std::string &left, std::string_view right) const {
        return fmt::format("  {:<16} {}\n", left, right);
    }

    std::string parts() {
        std::string out;
        if (block_.is_percent) {
            return row("%", "the program begins or ends here");
        }
        if (block_.deletable) {
            out += row("/", "left out while block delete is on");
        }
        if (block_.isNumbered) {
            out += row(fmt::format("N{}", block_.sequence), "number of the line, without effect");
        }
        const detail::Printer printer(arena_, line_);
        if (hasOword()) {
            const detail::OWord &oword = arena_.owords[block_.oword];
            out += row(printer.oword(oword), oword_text(oword.kind));
        }
        for (std::uint32_t i = 0; i < block_.word_count; ++i) {
            const detail::Word &word = arena_.words[block_.first_word + i];
            out += row(printer.word(word), describe(word, printer));
        }
        for (std::uint32_t i = 0; i < block_.setting_count; ++i) {
            const detail::Setting &setting = arena_.settings[block_.first_setting + i];
            out += row(printer.setting(setting), "sets a parameter" + computed(printer.value(setting.value)));
        }
        for (std::uint32_t i = 0; i < block_.comment_count; ++i) {
            const detail::Comment &comment = arena_.comments[block_.first_comment + i];
            const std::string_view text = line_.substr(comment.begin, comment.end - comment.begin);
            out += row("(" + std::string(text) + ")", comment_text(text));
        }
        return out;
    }

    /// " = 5" for a value that is an expression and can be computed.
    std::string computed(const std::string &value) {
        double number = 0;
        return compute(value, number) && !parse_double(value) ? fmt::format(", here {:g}", number)
                                                              : std::string();
    }
    bool compute(const std::string &value, double &number) {
        constexpr int SCRATCH = 31;
        Bench other;
        const bool done = other.run(std::string(before_) + fmt::format("\n#{}=[{}]", SCRATCH, value));
        number = done ? other.parameter(SCRATCH) : 0;
        return done;
    }

    std::string describe(const detail::Word &word, const detail::Printer &printer) {
        const char letter = static_cast<char>(detail::letter_text(word.letter) | 0x20);
        const std::string value = word.expression == detail::NO_ID ? detail::Printer::number(word.value)
                                                                   : printer.value(word.expression);
        double number = word.value;
        const bool known = word.expression == detail::NO_ID || compute(value, number);
        if (letter == 'g' || letter == 'm') {
            return describe_code(letter, number, known);
        }
        const std::string shown = known ? fmt::format("{:g}", number) : value;
        if (const std::string meaning = meaning_of(letter); !meaning.empty()) {
            return fmt::format("{}: {}", meaning, shown);
        }
        const int axis = geometry::axis_of_letter(letter);
        if (axis >= 0) {
            return describe_axis(axis, shown);
        }
        switch (letter) {
        case 'f': return "feed rate " + shown + " " + feed_unit();
        case 's':
            return "speed of the spindle " + shown +
                   (codes_.g[SPINDLE_MODE] == SURFACE_SPEED
                        ? (codes_.g[UNITS] == INCHES ? " feet/min at the surface" : " m/min at the surface")
                        : " rev/min");
        case 't': return "selects tool " + shown;
        case '@': return "distance from the origin of the plane " + shown + " " + length_unit();
        case '^': return "angle in the plane " + shown + " deg";
        default: return "no code in this line has such a word";
        }
    }

    static const detail::Code *find_row(char letter, double number) {
        return detail::find_code(
            make_code(letter, static_cast<int>(std::lround(letter == 'g' ? number * 10 : number))));
    }

    std::string describe_code(char letter, double number, bool known) {
        const detail::Code *const code = known ? find_row(letter, number) : nullptr;
        return code != nullptr ? std::string(code->meaning) : "no such code";
    }

    /// Meaning of a letter for a code of the block, or for the current motion mode.
    std::string meaning_of(char letter) {
        std::string found;
        bool has_motion = false;
        for (std::uint32_t i = 0; i < block_.word_count; ++i) {
            const detail::Word &word = arena_.words[block_.first_word + i];
            const char code_letter = static_cast<char>(detail::letter_text(word.letter) | 0x20);
            if ((code_letter != 'g' && code_letter != 'm') || word.expression != detail::NO_ID) {
                continue;
            }
            const detail::Code *code = find_row(code_letter, word.value);
            has_motion = has_motion || (code != nullptr && code->usesAxes);
            if (code != nullptr && found.empty()) {
                found = std::string(code->word_text(letter));
            }
        }
        const detail::Code *mode = has_motion ? nullptr : detail::find_code(make_code('g', codes_.g[MOTION]));
        return found.empty() && mode != nullptr ? std::string(mode->word_text(letter)) : found;
    }

    std::string describe_axis(int axis, const std::string &shown) const {
        const std::string unit = geometry::isAngular(axis) ? "deg" : length_unit();
        return codes_.g[DISTANCE] == INCREMENTAL
                   ? fmt::format("by {} {} along {}", shown, unit, geometry::AXIS_LETTERS[axis])
                   : fmt::format("{} = {} {}", geometry::AXIS_LETTERS[axis], shown, unit);
    }

    std::string feed_unit() const {
        switch (codes_.g[FEED_MODE]) {
        case INVERSE_TIME: return "moves per minute";
        case PER_REVOLUTION: return length_unit() + "/rev";
        default: return length_unit() + "/min";
        }
    }

    std::string modes() const {
        std::string out = "in force:";
        for (std::size_t i = 1; i < codes_.g.size(); ++i) {
            const detail::Code *const code = detail::find_code(make_code('g', codes_.g[i]));
            out += code != nullptr && i != 2 ? " " + to_upper(code_name(code->id)) : "";
        }
        return out + fmt::format(", F{:g} {}, S{:g}\n", codes_.settings[1], feed_unit(), codes_.settings[2]);
    }

    std::string_view line_, before_;
    Bench bench_;
    detail::Names names_;
    detail::Arena arena_;
    detail::Block block_;
    ActiveCodes codes_;
};

}  // namespace

Explanation explain_line(std::string_view line, std::string_view before) {
    return Explainer(line, before).run();
}

}  // namespace mw::gcode
