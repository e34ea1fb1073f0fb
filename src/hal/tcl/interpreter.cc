// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tcl/interpreter.hh"

#include <unistd.h>

#include <cstdio>
#include <iostream>

#include <fmt/format.h>

#include "base/text.hh"
#include "hal/tcl/source_limits.hh"

namespace mw::hal::tcl {

namespace {

std::string text_of(Tcl_Obj *object) {
    return object == nullptr ? "" : Tcl_GetString(object);
}

/// The line of a file in an error's trace: that of the outermost call in that file.
int line_of(const std::string &trace, const std::string &path) {
    const std::string mark = fmt::format("(file \"{}\" line ", path);
    const std::size_t at = trace.find(mark);
    if (at == std::string::npos) {
        return 0;
    }
    const std::size_t start = at + mark.size();
    const auto line = parse_int(trace.substr(start, trace.find(')', start) - start));
    return line ? static_cast<int>(*line) : 0;
}

/// The procedure of the error, with its line; empty outside procedures.
std::string procedure_of(const std::string &trace) {
    const std::size_t at = trace.find("(procedure \"");
    const std::size_t end = at == std::string::npos ? at : trace.find(')', at);
    return end == std::string::npos ? "" : trace.substr(at + 1, end - at - 1);
}

/// Ends the script, not the process: a realtime process may require an orderly end.
int run_exit(ClientData data, Tcl_Interp *interpreter, int count, Tcl_Obj *const objects[]) {
    int status = 0;
    if (count > 2 || (count == 2 && Tcl_GetIntFromObj(interpreter, objects[1], &status) != TCL_OK)) {
        Tcl_WrongNumArgs(interpreter, 1, objects, "?returnCode?");
        return TCL_ERROR;
    }
    static_cast<script::Session *>(data)->end();
    Tcl_SetErrorCode(interpreter, "HAL", "EXIT", std::to_string(status).c_str(), nullptr);
    Tcl_SetObjResult(interpreter, Tcl_NewStringObj("exit", -1));
    return TCL_ERROR;
}

}  // namespace

Interpreter::Interpreter(script::Session &session) : session_(session), interpreter_(Tcl_CreateInterp()) {
    // Without its script library Tcl still has all built-in commands.
    if (Tcl_Init(interpreter_) != TCL_OK) {
        session_.warn({}, fmt::format("Tcl: {}", Tcl_GetStringResult(interpreter_)));
    }
    add_commands(interpreter_, session_);
    add_source_limits(interpreter_);
    Tcl_CreateObjCommand(interpreter_, "exit", run_exit, &session_, nullptr);
    if (session_.options().ini != nullptr) {
        add_ini(interpreter_, *session_.options().ini);
    }
    (void)Tcl_PkgProvide(interpreter_, "Hal", "1.0");
}

Interpreter::~Interpreter() {
    Tcl_DeleteInterp(interpreter_);
}

void Interpreter::set_arguments(const std::string &path, const std::vector<std::string> &arguments) {
    Tcl_Obj *list = Tcl_NewListObj(0, nullptr);
    for (const std::string &argument : arguments) {
        Tcl_ListObjAppendElement(nullptr, list,
                                 Tcl_NewStringObj(argument.data(), static_cast<int>(argument.size())));
    }
    Tcl_SetVar2Ex(interpreter_, "argv", nullptr, list, TCL_GLOBAL_ONLY);
    Tcl_SetVar2Ex(interpreter_, "argc", nullptr, Tcl_NewIntObj(static_cast<int>(arguments.size())),
                  TCL_GLOBAL_ONLY);
    Tcl_SetVar2Ex(interpreter_, "argv0", nullptr, Tcl_NewStringObj(path.c_str(), -1), TCL_GLOBAL_ONLY);
}

Error Interpreter::error_here(const std::string &path) const {
    const std::string trace = text_of(Tcl_GetVar2Ex(interpreter_, "errorInfo", nullptr, TCL_GLOBAL_ONLY));
    std::string message = Tcl_GetStringResult(interpreter_);
    // The position reported by a sourced HAL file comes first.
    Error error{message, SourcePlace{path, line_of(trace, path), 0}, {}};
    if (message.find("\"::tp::") != std::string::npos) {
        error.hint = "the script is written for two passes: [HAL]TWOPASS = on";
    }
    const std::string procedure = procedure_of(trace);
    if (!procedure.empty()) {
        error.hint = "in " + procedure;
    }
    return error;
}

Result<> Interpreter::run_file(const std::string &path, const std::vector<std::string> &arguments) {
    if (const auto checked = check_nesting_of_file(path); !checked) {
        return checked;
    }
    set_arguments(path, arguments);
    const int status = Tcl_EvalFile(interpreter_, path.c_str());
    const bool failed = status != TCL_OK && status != TCL_RETURN;
    const Error error = error_here(path);
    (void)Tcl_Eval(interpreter_, "flush stdout");
    if (!failed) {
        return {};
    }
    if (session_.hasEnded()) {
        const std::string code = text_of(Tcl_GetVar2Ex(interpreter_, "errorCode", nullptr, TCL_GLOBAL_ONLY));
        return code.ends_with(" 0") ? Result<>{} : fail("the script ended with a failure", {path, 0, 0});
    }
    return std::unexpected(error);
}

Result<> Interpreter::run_standard_input() {
    const bool is_terminal = isatty(STDIN_FILENO) == 1;
    Tcl_SetVar2Ex(interpreter_, "tcl_interactive", nullptr, Tcl_NewIntObj(is_terminal ? 1 : 0),
                  TCL_GLOBAL_ONLY);
    Result<> first;
    std::string text;
    std::string line;
    while (!session_.hasEnded()) {
        if (is_terminal) {
            std::fputs(text.empty() ? "haltcl: " : "      > ", stdout);
            std::fflush(stdout);
        }
        if (!std::getline(std::cin, line)) {
            break;
        }
        text += line + '\n';
        if (Tcl_CommandComplete(text.c_str()) == 0) {
            continue;
        }
        const auto checked = check_nesting(text, "");
        const int status = checked ? Tcl_EvalEx(interpreter_, text.c_str(), -1, TCL_EVAL_GLOBAL) : TCL_ERROR;
        text.clear();
        const std::string result = checked ? Tcl_GetStringResult(interpreter_) : checked.error().str();
        (void)Tcl_Eval(interpreter_, "flush stdout");
        if (session_.hasEnded()) {
            break;
        }
        if (status != TCL_OK) {
            session_.output().error(Error{result, {}, {}});
            first = first ? fail(result) : first;
            if (!is_terminal && !session_.options().keepsGoing) {
                break;
            }
        } else if (is_terminal && !result.empty()) {
            fmt::print("{}\n", result);
        }
    }
    if (is_terminal) {
        std::fputc('\n', stdout);
        return {};
    }
    return first;
}

}  // namespace mw::hal::tcl
