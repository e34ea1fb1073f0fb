// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/syntax/syntax_errors.hh"

namespace mw::gcode::detail {

std::vector<diagnostics::Diagnostic> syntax_errors(Program &program, int after, int most) {
    std::vector<diagnostics::Diagnostic> out;
    const int last = program.count_lines();
    for (int line = after + 1; line <= last && static_cast<int>(out.size()) < most; ++line) {
        const BlockView view = program.block(line);
        if (view.block->error != NO_ID) {
            const SyntaxError &error = view.arena->errors[view.block->error];
            out.push_back({diagnostics::Severity::ERROR,
                           {error.message, {program.path(), line, static_cast<int>(error.column)}, {}},
                           {},
                           std::string(program.line_text(line))});
        }
        if (view.block->is_percent && line > program.first_content_line()) {
            break;
        }
    }
    return out;
}

}  // namespace mw::gcode::detail
