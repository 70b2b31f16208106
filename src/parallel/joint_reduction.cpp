// SPDX-License-Identifier: BSD-3-Clause
#include "parallel/joint_reduction.hpp"

#include <algorithm>
#include <cstring>

#include "parallel/handle.hpp"

namespace carrom {

namespace {

void combine(void* from, void* into, int* count, MPI_Datatype*) {
    for (int k = 0; k < *count; ++k) {
        const std::size_t place = static_cast<std::size_t>(k) * sizeof(JointWords);
        JointWords one, both; // MPI's buffers need not be aligned
        std::memcpy(&one, static_cast<const char*>(from) + place, sizeof one);
        std::memcpy(&both, static_cast<const char*>(into) + place, sizeof both);
        for (std::size_t i = 0; i < one.counts.size(); ++i) both.counts[i] += one.counts[i];
        both.largest = std::max(both.largest, one.largest) + 0.0;
        std::memcpy(static_cast<char*>(into) + place, &both, sizeof both);
    }
}

} // namespace

void reduce(JointWords& words, const Communicator& communicator) {
    Communicator::Handle& handle = communicator.handle();
    ++handle.traffic.collectives;
    if (handle.is_alone()) return;
    MPI_Datatype type = MPI_DATATYPE_NULL;
    MPI_Op operation = MPI_OP_NULL;
    MPI_Type_contiguous(sizeof(JointWords), MPI_BYTE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(combine, 1, &operation);
    MPI_Allreduce(MPI_IN_PLACE, &words, 1, type, operation, handle.comm);
    MPI_Op_free(&operation);
    MPI_Type_free(&type);
}

} // namespace carrom
