#pragma once
// Moves and weights for a task that names none. Pure; any thread.

#include "shared/task/task.h"

namespace tenon {

/// Sets what a task without `primitives` plans with, from its own sizes: steps of 1.2 times the
/// particles' reach (a push from anywhere in it meets what is a step away), long pushes past
/// everything that there is, straight moves from anywhere, moves that the guides suggest, and a
/// price for each move of the way that the goal's tolerance is long.
void derive_moves(Task& task);

}  // namespace tenon
