// SPDX-License-Identifier: BSD-3-Clause
#include "checkpoint_fields.hpp"

#include <bit>
#include <type_traits>

namespace carrom {

void set_bits(const Column& column, Disc& disc, std::uint64_t bits) {
    std::visit([&](auto field) { disc.*field = std::bit_cast<std::remove_reference_t<decltype(disc.*field)>>(bits); }, column.field);
}

hid_t type_of(const Column& column) {
    return std::holds_alternative<double Disc::*>(column.field) ? H5T_NATIVE_DOUBLE : H5T_NATIVE_UINT64;
}

void write_header(hid_t group, const CheckpointHeader& header) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::write_scalar(group, entry.name, header.*field); }, entry.field);
    if (!header.frame.is_moving) return;
    for (const FrameField& entry : checkpoint_frame) h5::write_scalar(group, entry.name, header.frame.*entry.field);
    if (header.frame.period_x == 0 && header.frame.period_y == 0) return;
    for (const FrameField& entry : checkpoint_periods) h5::write_scalar(group, entry.name, header.frame.*entry.field);
}

CheckpointHeader read_header(hid_t group) {
    CheckpointHeader header;
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { h5::read_scalar(group, entry.name, header.*field); }, entry.field);
    header.frame.is_moving = H5Lexists(group, checkpoint_frame[0].name, H5P_DEFAULT) > 0;
    if (header.frame.is_moving)
        for (const FrameField& entry : checkpoint_frame) h5::read_scalar(group, entry.name, header.frame.*entry.field);
    if (H5Lexists(group, checkpoint_periods[0].name, H5P_DEFAULT) > 0)
        for (const FrameField& entry : checkpoint_periods) h5::read_scalar(group, entry.name, header.frame.*entry.field);
    return header;
}

bool has_spins(hid_t file) { return H5Lexists(file, "/carrom/discs", H5P_DEFAULT) > 0 && H5Lexists(file, spin_column, H5P_DEFAULT) > 0; }

void broadcast(CheckpointHeader& header, const Communicator& communicator) {
    for (const HeaderField& entry : checkpoint_header)
        std::visit([&](auto field) { communicator.broadcast(header.*field); }, entry.field);
    communicator.broadcast(header.frame);
    std::uint64_t has_spins = header.has_spins ? 1 : 0;
    communicator.broadcast(has_spins);
    header.has_spins = has_spins == 1;
}

} // namespace carrom
