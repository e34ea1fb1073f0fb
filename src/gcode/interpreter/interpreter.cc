// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/interpreter.hh"

#include <filesystem>

#include "base/atomic_file.hh"
#include "gcode/interpreter/codes/executor.hh"
#include "gcode/interpreter/codes/synchronisation.hh"
#include "gcode/interpreter/flow/flow.hh"
#include "gcode/interpreter/read_ahead.hh"

namespace mw::gcode {

struct Interpreter::Impl {
    Impl(Canon &canon, World &world, ToolSource &tools, ParameterSource &source, Settings given)
        : settings(std::move(given)), target(canon), executor(world, tools, source, settings, names),
          flow(executor, names, canon, settings), history(executor, flow) {}

    Settings settings;
    Canon &target;
    detail::Names names;
    detail::Executor executor;
    detail::Flow flow;
    ReadAhead history;
};

Interpreter::Interpreter(Canon &canon, World &world, ToolSource &tools, ParameterSource &parameters,
                         Settings settings)
    : impl_(std::make_unique<Impl>(canon, world, tools, parameters, std::move(settings))) {}

Interpreter::~Interpreter() = default;

Result<> Interpreter::load_parameters(const std::string &path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return {};
    }
    return impl_->executor.parameters.load(path);
}

Result<> Interpreter::save_parameters(const std::string &path) const {
    return write_file_with_backup(path, impl_->history.parameter_text());
}

Result<> Interpreter::begin() {
    detail::Executor &executor = impl_->executor;
    executor.modes.units = impl_->settings.initial_units.value_or(executor.world().machine_units());
    if (Result<> loaded = executor.remaps.load(impl_->settings.remaps); !loaded) {
        return loaded;
    }
    if (Result<> loaded = impl_->flow.load_scripts(); !loaded) {
        return loaded;
    }
    executor.canon.enter_block(nullptr, 0, 0, false, 0);
    if (impl_->settings.start_tolerance_mm > 0) {
        constexpr double MM_PER_INCH = 25.4;
        detail::State &state = executor.modes;
        state.tolerance =
            impl_->settings.start_tolerance_mm / (state.units == LengthUnits::INCH ? MM_PER_INCH : 1.0);
        executor.canon.take(SetMotionControlMode{state.control, state.tolerance});
    }
    detail::announce(executor.modes, executor.parts);
    detail::synchronise(executor.modes, executor.parts);
    executor.canon.flush(impl_->target);
    if (Result<> begun = impl_->flow.begin_scripts(); !begun) {
        return begun;
    }
    executor.canon.take(OnReset{});
    executor.canon.flush(impl_->target);
    if (!impl_->settings.startup_code.empty() && execute(impl_->settings.startup_code) == Step::FAILED) {
        Error error = impl_->flow.error().what;
        error.message = "the start-up code [RS274NGC]RS274NGC_STARTUP_CODE failed: " + error.message;
        return std::unexpected(std::move(error));
    }
    return {};
}

Result<> Interpreter::open(const std::string &path) {
    return impl_->flow.open(path);
}

void Interpreter::open_text(const std::string &name, std::string text) {
    impl_->flow.open_text(name, std::move(text));
}

void Interpreter::close() {
    impl_->flow.close();
}

Step Interpreter::step() {
    return impl_->flow.step();
}

Step Interpreter::execute(std::string_view line) {
    return impl_->flow.execute(line);
}

void Interpreter::synch() {
    detail::synchronise(impl_->executor.modes, impl_->executor.parts);
}

void Interpreter::abort() {
    impl_->flow.abort();
}

void Interpreter::announce() {
    detail::Executor &executor = impl_->executor;
    executor.canon.enter_block(nullptr, 0, 0, false, 0);
    detail::announce_modes(executor.modes, executor.parts);
    executor.canon.flush(impl_->target);
}

const std::vector<std::string> &Interpreter::warnings() const {
    return impl_->flow.scripts().warnings();
}

const diagnostics::Diagnostic &Interpreter::error() const {
    return impl_->flow.error();
}

ActiveCodes Interpreter::active_codes() const {
    return impl_->executor.active_codes();
}

int Interpreter::line() const {
    return impl_->flow.levels().here().line;
}

const std::string &Interpreter::file() const {
    return impl_->flow.levels().file();
}

int Interpreter::call_level() const {
    return impl_->flow.levels().call_level();
}

bool Interpreter::isMoveHeld() const {
    return !impl_->executor.canon.empty();
}

bool Interpreter::isContinuable() const {
    return impl_->flow.isContinuable();
}

bool Interpreter::isAtFileEnd() const {
    return impl_->flow.levels().here().isAtEnd();
}

std::vector<diagnostics::Diagnostic> Interpreter::syntax_errors(int after, int most) {
    detail::Program *const main = impl_->flow.levels().main();
    return main == nullptr ? std::vector<diagnostics::Diagnostic>() : main->syntax_errors(after, most);
}

void Interpreter::mark_progress(double seconds) {
    impl_->flow.budget().mark_progress(seconds);
}

bool Interpreter::isBudgetSpent() const {
    return impl_->flow.budget().isSpent();
}

FilePlace Interpreter::place_in_file() const {
    const detail::Levels &levels = impl_->flow.levels();
    const detail::Program *const main = levels.main();
    return main == nullptr ? FilePlace()
                           : FilePlace{main->text().place_of(levels.main_line()), main->text().count_bytes()};
}

std::string_view Interpreter::subroutine() const {
    const detail::NameId label = impl_->flow.levels().subroutine();
    return label == detail::NO_ID ? std::string_view() : impl_->names.text(label);
}

std::string Interpreter::line_text(const std::string &file, int line) const {
    return impl_->flow.files().line_text(file, line);
}

NextLine Interpreter::next_line() const {
    const detail::Levels &levels = impl_->flow.levels();
    const bool is_script = levels.isInCall() && levels.top().isInScript();
    return {is_script ? 0 : levels.here().next, levels.main_line(), levels.isInCall(),
            levels.here().program == levels.main()};
}

const InterpreterState &Interpreter::state() const {
    return impl_->executor;
}

void Interpreter::restore(const InterpreterState &kept) {
    impl_->executor.restore(kept);
}

ReadAhead &Interpreter::read_ahead() {
    return impl_->history;
}

void Interpreter::know_tools(const std::map<int, ToolEntry> &entries) {
    for (const auto &[index, entry] : entries) {
        impl_->executor.tools.set(index, entry);
    }
    impl_->executor.tools.commit();
}

Result<std::string> Interpreter::pack_state() const {
    return pack(state(), impl_->names);
}

Result<InterpreterState> Interpreter::unpack_state(std::string_view bytes) {
    return unpack(bytes, state(), impl_->names);
}

std::uint64_t Interpreter::count_script_calls() const {
    return impl_->flow.scripts().count_calls();
}

ProgramLimits &Interpreter::limits() {
    return impl_->flow.scripts().limits();
}

double Interpreter::parameter(int number) const {
    const bool in_range = number >= 1 && number < detail::PARAMETER_COUNT;
    return in_range ? impl_->executor.evaluator().numbered(number) : 0.0;
}

}  // namespace mw::gcode
