// SPDX-License-Identifier: GPL-2.0-or-later
#include "gcode/interpreter/expressions/parameters.hh"

#include <algorithm>
#include <utility>

namespace mw::gcode::detail {
namespace {

using Kind = ParameterChange::Kind;

}  // namespace

Parameters::Parameters() : values_(PARAMETER_COUNT, 0.0), frames_(1) {
    values_[P_COORDINATE_SYSTEM] = 1;
    values_[P_DEBUG_SHOWN] = 1;
}

void Parameters::set(int number, double value) {
    double &slot = values_[static_cast<std::size_t>(number)];
    log_.push_back({Undo::Kind::NUMBER, number, NO_ID, slot});
    record({Kind::NUMBER, number, NO_ID, value});
    slot = value;
}

std::optional<double> Parameters::named(NameId id, bool global) const {
    if (global) {
        return id < globals_.size() ? globals_[id] : std::nullopt;
    }
    for (const Named &local : frames_[depth_ - 1].locals) {
        if (local.id == id) {
            return local.value;
        }
    }
    return std::nullopt;
}

void Parameters::set_named(NameId id, bool global, double value) {
    record({global ? Kind::GLOBAL : Kind::LOCAL, 0, id, value});
    if (global) {
        if (id >= globals_.size()) {
            globals_.resize(id + 1);
        }
        log_.push_back({Undo::Kind::GLOBAL, 0, id, globals_[id]});
        globals_[id] = value;
        return;
    }
    std::vector<Named> &locals = frames_[depth_ - 1].locals;
    for (Named &local : locals) {
        if (local.id == id) {
            log_.push_back({Undo::Kind::LOCAL, 0, id, local.value});
            local.value = value;
            return;
        }
    }
    log_.push_back({Undo::Kind::LOCAL, 0, id, std::nullopt});
    locals.push_back({id, value});
}

void Parameters::forget_names() {
    record({Kind::FORGET_NAMES});
    globals_.clear();
    frames_[depth_ - 1].locals.clear();
    log_.clear();
}

void Parameters::push_call() {
    record({Kind::PUSH_CALL});
    if (depth_ == frames_.size()) {
        frames_.emplace_back();
    }
    Frame &frame = frames_[depth_++];
    frame.locals.clear();
    frame.more.clear();
    std::copy_n(values_.begin() + 1, ARGUMENT_COUNT, frame.arguments);
}

void Parameters::set_arguments(std::span<const double> given) {
    std::ranges::copy(given, values_.begin() + 1);
    for (std::size_t i = 0; i < given.size(); ++i) {
        record({Kind::NUMBER, static_cast<int>(i) + 1, NO_ID, given[i]});
    }
}

void Parameters::keep_aside(std::size_t count) {
    record({Kind::KEEP_ASIDE, static_cast<int>(count)});
    const auto first = values_.begin() + 1 + ARGUMENT_COUNT;
    frames_[depth_ - 1].more.assign(first, first + static_cast<std::ptrdiff_t>(count) - ARGUMENT_COUNT);
}

void Parameters::pop_call(bool sharing) {
    record({sharing ? Kind::POP_SHARING_CALL : Kind::POP_CALL});
    const Frame &frame = frames_[--depth_];
    std::ranges::copy(frame.more, values_.begin() + 1 + ARGUMENT_COUNT);
    if (!sharing) {
        std::copy_n(frame.arguments, ARGUMENT_COUNT, values_.begin() + 1);
    }
}

std::vector<std::pair<NameId, double>> Parameters::locals(int level) const {
    std::vector<std::pair<NameId, double>> out;
    for (const Named &local : frames_[static_cast<std::size_t>(level)].locals) {
        out.emplace_back(local.id, local.value);
    }
    return out;
}

std::vector<std::pair<NameId, double>> Parameters::globals() const {
    std::vector<std::pair<NameId, double>> out;
    for (std::size_t id = 0; id < globals_.size(); ++id) {
        if (globals_[id]) {
            out.emplace_back(static_cast<NameId>(id), *globals_[id]);
        }
    }
    return out;
}

std::array<double, ARGUMENT_COUNT> Parameters::saved_arguments(int level) const {
    std::array<double, ARGUMENT_COUNT> out{};
    std::ranges::copy(frames_[static_cast<std::size_t>(level)].arguments, out.begin());
    return out;
}

void Parameters::forget_local(NameId id) {
    std::erase_if(frames_[depth_ - 1].locals, [&](const Named &local) { return local.id == id; });
    record({Kind::FORGET_LOCAL, 0, id});
}

void Parameters::rollback() {
    const std::vector<Undo> log = std::exchange(log_, {});
    for (auto entry = log.rbegin(); entry != log.rend(); ++entry) {
        if (entry->kind == Undo::Kind::NUMBER) {
            set(entry->number, *entry->old);
        } else if (entry->old) {
            set_named(entry->id, entry->kind == Undo::Kind::GLOBAL, *entry->old);
        } else if (entry->kind == Undo::Kind::GLOBAL) {
            globals_[entry->id].reset();
            record({Kind::FORGET_GLOBAL, 0, entry->id});
        } else {
            forget_local(entry->id);
        }
    }
    log_.clear();
}

void Parameters::take_changes(std::vector<ParameterChange> &changes) {
    if (changes.empty()) {
        changes.swap(changes_);
    } else {
        changes.insert(changes.end(), changes_.begin(), changes_.end());
        changes_.clear();
    }
}

void Parameters::apply(const ParameterChange &change) {
    switch (change.kind) {
    case Kind::NUMBER: set(change.number, change.value); break;
    case Kind::GLOBAL: set_named(change.id, true, change.value); break;
    case Kind::LOCAL: set_named(change.id, false, change.value); break;
    case Kind::FORGET_GLOBAL: globals_[change.id].reset(); break;
    case Kind::FORGET_LOCAL: forget_local(change.id); break;
    case Kind::FORGET_NAMES: forget_names(); break;
    case Kind::PUSH_CALL: push_call(); break;
    case Kind::KEEP_ASIDE: keep_aside(static_cast<std::size_t>(change.number)); break;
    case Kind::POP_CALL: pop_call(false); break;
    case Kind::POP_SHARING_CALL: pop_call(true); break;
    }
    commit();
}

}  // namespace mw::gcode::detail
