// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/recovery.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::task {
namespace {

/// Interval of progress records: with the disk's time well below a second.
constexpr std::int64_t EVERY_NS = 200000000;

}  // namespace

std::string refusal_of(const journal::Run &run) {
    if (!run.doubt.has_value() || run.progress->block <= run.doubt->block) {
        return {};
    }
    return fmt::format(
        "the state at line {} depends on {} in line {}; the nearest possible line before it is {}",
        run.progress->line, run.doubt->what, run.doubt->line, std::max(1, run.doubt->line));
}

void Recovery::offer_run(journal::Run run) {
    refusal_ = refusal_of(run);
    offer_ = std::move(run);
}

std::string Recovery::find() {
    if (!isOn() || !writer_->found().run.has_value()) {
        return {};
    }
    offer_run(*writer_->found().run);
    refusal_ = writer_->found().refusal.empty() ? refusal_ : writer_->found().refusal;
    const std::string what =
        fmt::format("{} was interrupted at line {}", offer_->start.program, offer_->progress->line);
    return refusal_.empty() ? what + ": home the machine, then continue the program with 'millwright "
                                     "recover' (RecoverProgram)"
                            : what + " and cannot be continued there: " + refusal_;
}

void Recovery::prepare(const std::string &program, const StartRecord &record, const std::string &why_not) {
    prepared_ = journal::Run{};
    prepared_->start = {0, program, {}, record.pack()};
    if (!why_not.empty()) {
        prepared_->doubt = journal::Doubt{0, 1, why_not};
    }
}

std::string Recovery::begin(std::uint32_t first) {
    if (!prepared_.has_value()) {
        return {};
    }
    std::string dropped =
        offer_.has_value()
            ? fmt::format("{} can no longer be continued from line {}: another program was started",
                          offer_->start.program, offer_->progress->line)
            : "";
    offer_.reset();
    refusal_.clear();
    run_ = std::move(prepared_);
    prepared_.reset();
    first_ = first;
    noted_ns_ = 0;
    writer_->begin(run_->start, {}, run_->doubt);
    return dropped;
}

Result<> Recovery::call_back(const RunPlace &place, ChecksumMarks &marks) {
    if (!run_.has_value()) {
        return fail("the program is not journalled ([TASK]JOURNAL_FILE)");
    }
    journal::Run run = *run_;
    const std::uint32_t block = std::max(first_, place.block);
    const auto calls = marks.before(block);
    if (!calls.has_value()) {
        return fail("it has not begun");
    }
    run.progress = journal::Progress{block, place.line, *calls, place.position, place.tool, sum_of_tools_};
    const std::string why = refusal_of(run);
    if (!why.empty()) {
        return fail(why);
    }
    offer_ = std::move(run);
    refusal_.clear();
    run_.reset();
    return {};
}

void Recovery::begin_again(const StartRecord &record, std::uint64_t calls, std::uint64_t tools) {
    run_ = std::move(offer_);
    offer_.reset();
    run_->start.state = record.pack();
    run_->progress->calls = calls;
    run_->progress->tools = tools;
    first_ = static_cast<std::uint32_t>(run_->progress->block);
    noted_ns_ = 0;
    writer_->begin(run_->start, run_->progress, run_->doubt);
}

void Recovery::step(std::int64_t now_ns, const RunPlace &place, ChecksumMarks &marks,
                    const ToolStore &tools) {
    if (!run_.has_value()) {
        return;
    }
    const bool first = !run_->progress.has_value();
    const bool elsewhere = !first && std::max(first_, place.block) != run_->progress->block;
    const bool due = now_ns - noted_ns_ >= EVERY_NS;
    if (place.block > 0 && (first || (elsewhere && due))) {
        noted_ns_ = now_ns;
        note(place, marks, tools);
    }
}

void Recovery::note(const RunPlace &place, ChecksumMarks &marks, const ToolStore &tools) {
    const std::uint32_t block = std::max(first_, place.block);
    const auto calls = marks.before(block);
    if (!calls.has_value()) {
        return;  // the program was not started
    }
    if (summed_version_ != tools.version()) {
        summed_version_ = tools.version();
        sum_of_tools_ = sum_of_tools(tools);
    }
    run_->progress = journal::Progress{block, place.line, *calls, place.position, place.tool, sum_of_tools_};
    writer_->note(*run_->progress);
}

void Recovery::note_doubt(std::uint32_t block, int line, const std::string &what) {
    if (run_.has_value() && !run_->doubt.has_value()) {
        run_->doubt = journal::Doubt{block, line, what};
        writer_->note(*run_->doubt);
    }
}

void Recovery::end() {
    prepared_.reset();
    if (run_.has_value()) {
        run_.reset();
        writer_->end();
    }
}

void Recovery::cut_short() {
    if (!run_.has_value() || !run_->progress.has_value()) {
        end();
        return;
    }
    offer_run(std::move(*run_));
    run_.reset();
}

std::optional<std::string> Recovery::take_trouble() {
    return writer_ != nullptr ? writer_->take_trouble() : std::nullopt;
}

std::optional<std::string> Recovery::take_delay(std::int64_t now_ns) {
    return writer_ != nullptr ? writer_->take_delay(now_ns) : std::nullopt;
}

Result<const journal::Run *> Recovery::offer() const {
    if (!offer_.has_value()) {
        return fail("no program was interrupted");
    }
    return refusal_.empty() ? Result<const journal::Run *>(&*offer_) : fail(refusal_);
}

void Recovery::forget() {
    if (offer_.has_value()) {
        offer_.reset();
        refusal_.clear();
        writer_->forget();
    }
}

void Recovery::show(RecoveryStatus &status) const {
    if (!offer_.has_value()) {
        if (status.isOffered || !status.program.empty()) {
            status = {};
        }
        return;
    }
    status.isOffered = refusal_.empty();
    status.line = offer_->progress->line;
    status.block = offer_->progress->block;
    if (status.program != offer_->start.program) {
        status.program.assign(offer_->start.program);
    }
    if (status.refusal != refusal_) {
        status.refusal.assign(refusal_);
    }
}

}  // namespace mw::task
