// SPDX-License-Identifier: GPL-2.0-or-later
#include "programs/run/trace_writer.hh"

#include <cerrno>
#include <charconv>
#include <cstring>

namespace mw::programs {
namespace {

template <class T>
void append(std::string &row, T value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    row.append(buffer, end);
}

}  // namespace

TraceWriter::TraceWriter(std::FILE *file, std::string path, unsigned axis_mask, int num_joints)
    : file_(file, &std::fclose), path_(std::move(path)), axis_mask_(axis_mask), num_joints_(num_joints) {}

Result<TraceWriter> TraceWriter::create(const std::string &path, unsigned axis_mask, int num_joints) {
    std::FILE *file = std::fopen(path.c_str(), "wbe");
    if (file == nullptr) {
        return fail("cannot write the trace '" + path + "': " + std::strerror(errno));
    }
    TraceWriter writer(file, path, axis_mask, num_joints);
    std::string header = "time_ns,line";
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((axis_mask & (1U << axis)) != 0) {
            header += std::string(",axis.") + geometry::AXIS_LETTERS_LOWER[axis];
        }
    }
    for (int joint = 0; joint < num_joints; ++joint) {
        header += ",joint." + std::to_string(joint);
    }
    std::fprintf(file, "%s\n", header.c_str());
    return writer;
}

void TraceWriter::write(const motion::TraceSample &sample) {
    if (start_ns_ < 0) {
        start_ns_ = sample.time_ns;
    }
    row_.clear();
    append(row_, sample.time_ns - start_ns_);
    row_ += ',';
    append(row_, sample.line);
    for (int axis = 0; axis < MAX_AXES; ++axis) {
        if ((axis_mask_ & (1U << axis)) != 0) {
            row_ += ',';
            append(row_, sample.carte_pos_cmd[axis]);
        }
    }
    for (int joint = 0; joint < num_joints_; ++joint) {
        row_ += ',';
        append(row_, sample.joint_pos_cmd[static_cast<std::size_t>(joint)]);
    }
    row_ += '\n';
    failed_ = std::fwrite(row_.data(), 1, row_.size(), file_.get()) != row_.size() || failed_;
}

Result<> TraceWriter::close() {
    std::FILE *file = file_.release();
    const bool closed = std::fclose(file) == 0;
    if (!closed || failed_) {
        return fail("the trace '" + path_ + "' is incomplete: " + std::strerror(errno));
    }
    return {};
}

}  // namespace mw::programs
