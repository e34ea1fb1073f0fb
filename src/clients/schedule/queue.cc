// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/schedule/queue.hh"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace mw::schedule {
namespace {

constexpr int LAST_ZONE = 9;

Result<> check(const Job &job) {
    if (job.file.empty()) {
        return fail("a program needs the name of its file");
    }
    if (job.zone < 0 || job.zone > LAST_ZONE) {
        return fail(fmt::format("zone {} is not one of 0 (offsets) and 1 (G54) to 9 (G59.3)", job.zone));
    }
    const bool is_place = std::isfinite(job.x) && std::isfinite(job.y) && std::isfinite(job.z);
    const bool scaled = job.feed_percent >= 0 && job.spindle_percent >= 0 &&
                        std::isfinite(job.feed_percent) && std::isfinite(job.spindle_percent);
    if (!is_place || !scaled) {
        return fail("offsets are numbers, overrides are percentages from 0 on");
    }
    if (job.tool < 0) {
        return fail(fmt::format("there is no tool {}", job.tool));
    }
    return {};
}

}  // namespace

Result<> Queue::add(Job job) {
    if (auto good = check(job); !good.has_value()) {
        return good;
    }
    if (jobs_.size() >= MAX_JOBS) {
        return fail(fmt::format("the queue is full: {} programs wait", MAX_JOBS));
    }
    if (job.tag == 0) {
        const auto tag = next_tag();
        if (!tag.has_value()) {
            return std::unexpected(tag.error());
        }
        last_auto_tag_ = job.tag = *tag;
    }
    if (job.tag < 0 || job.tag > MAX_TAG) {
        return fail(fmt::format("a tag is a number from 1 to {}", MAX_TAG));
    }
    if (by_tag(job.tag) != nullptr) {
        return fail(fmt::format("the tag {} is that of a program that waits", job.tag));
    }
    insert(std::move(job));
    return {};
}

void Queue::insert(Job job) {
    const auto behind = std::ranges::upper_bound(jobs_, job.priority, {}, &Job::priority);
    jobs_.insert(behind, std::move(job));
}

Result<int> Queue::next_tag() const {
    int tag = last_auto_tag_;
    do {
        if (tag >= MAX_TAG) {
            return fail("no tag is left: set AutoTagId again");
        }
        ++tag;
    } while (by_tag(tag) != nullptr);
    return tag;
}

const Job *Queue::by_tag(int tag) const {
    const auto found = std::ranges::find(jobs_, tag, &Job::tag);
    return found == jobs_.end() ? nullptr : &*found;
}

const Job *Queue::by_index(std::int64_t index) const {
    const bool there = index >= 0 && index < static_cast<std::int64_t>(jobs_.size());
    return there ? &jobs_[static_cast<std::size_t>(index)] : nullptr;
}

bool Queue::remove(int tag) {
    return std::erase_if(jobs_, [tag](const Job &job) { return job.tag == tag; }) > 0;
}

bool Queue::set_priority(int tag, int priority) {
    const Job *const found = by_tag(tag);
    if (found == nullptr) {
        return false;
    }
    Job job = *found;
    job.priority = priority;
    remove(tag);
    insert(std::move(job));
    return true;
}

Result<> Queue::set_last_auto_tag(int tag) {
    if (tag < 0 || tag >= MAX_TAG) {
        return fail(fmt::format("AutoTagId is a number from 0 to {}", MAX_TAG - 1));
    }
    last_auto_tag_ = tag;
    return {};
}

std::uint32_t Queue::checksum() const {
    constexpr std::uint32_t BASIS = 2166136261U, PRIME = 16777619U;  // FNV-1a
    constexpr int BYTES = 4, BITS = 8;
    if (jobs_.empty()) {
        return 0;
    }
    std::uint32_t sum = BASIS;
    for (const Job &job : jobs_) {
        for (int i = 0; i < BYTES; ++i) {
            sum = (sum ^ (static_cast<std::uint32_t>(job.tag) >> (BITS * i) & 0xffU)) * PRIME;
        }
    }
    return sum;
}

}  // namespace mw::schedule
