// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/task/run/parameter_file.hh"

#include <utility>

namespace mw::task {

void ParameterFile::keep() {
    if (!isWriterAsked()) {
        return;
    }
    std::string text = reader_.parameter_text();
    if (text != kept_) {
        kept_ = text;
        writer_->keep_file(path_, std::move(text), journal::Old::BACKED_UP);
    }
}

Result<> ParameterFile::save() {
    if (!isWriterAsked()) {
        const LongCall::During call(reader_.call().call);
        return reader_.save_parameters();
    }
    kept_ = reader_.parameter_text();
    const LongCall::During call(reader_.call().call);
    return writer_->write_file(path_, kept_, journal::Old::BACKED_UP);
}

}  // namespace mw::task
