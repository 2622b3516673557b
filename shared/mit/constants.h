#pragma once
// Wire constants of the MIT mode as Damiao motors speak it: special frames, ranges, registers,
// error numbers. Numbers alone: the master's codec lives in hw, the motor's in sim, written apart.
//
// Frames, ranges and registers were read in descriptions of the protocol by others than its maker,
// which agree. Unverified in the maker's own manual: that a motor which is off answers a disable
// frame as it answers a command, that a lost master switches it off (kErrorLostMaster), that
// registers may be written while it is off without being stored, and that it gives a feedback where
// it is asked for one (kRequestFeedback).

#include <array>
#include <cstdint>

namespace tenon::mit {

/// Whom registers are asked: the motor's own number stands in the data.
inline constexpr std::uint32_t kRegisterId = 0x7FF;

// Special frames: seven times FFh, then one of these.
inline constexpr std::uint8_t kFiller = 0xFF;
inline constexpr std::uint8_t kClearError = 0xFB;
inline constexpr std::uint8_t kEnable = 0xFC;
inline constexpr std::uint8_t kDisable = 0xFD;
inline constexpr std::uint8_t kSaveZero = 0xFE;

// Of the gains in a command.
inline constexpr double kStiffnessMax = 500.0;  ///< Nm/rad, from 0
inline constexpr double kDampingMax = 5.0;      ///< Nm s/rad, from 0

// Register commands.
inline constexpr std::uint8_t kReadRegister = 0x33;
inline constexpr std::uint8_t kWriteRegister = 0x55;
inline constexpr std::uint8_t kSaveRegisters = 0xAA;
inline constexpr std::uint8_t kRequestFeedback = 0xCC;  ///< answered as a command is

// Registers.
inline constexpr std::uint8_t kMasterId = 7;      ///< MST_ID: of its feedback
inline constexpr std::uint8_t kMotorId = 8;       ///< ESC_ID: of its commands
inline constexpr std::uint8_t kTimeout = 9;       ///< TIMEOUT, in kTimeoutUnit_us; 0: never
inline constexpr std::uint8_t kControlMode = 10;  ///< CTRL_MODE
inline constexpr std::uint8_t kPositionMax = 21;  ///< PMAX, float, rad
inline constexpr std::uint8_t kVelocityMax = 22;  ///< VMAX, float, rad/s
inline constexpr std::uint8_t kTorqueMax = 23;    ///< TMAX, float, Nm

inline constexpr std::uint32_t kTimeoutUnit_us = 50;
inline constexpr std::uint32_t kModeMit = 1;

// The high half of a feedback's first byte.
inline constexpr std::uint8_t kStateOff = 0x0;
inline constexpr std::uint8_t kStateOn = 0x1;
inline constexpr std::uint8_t kErrorOverVoltage = 0x8;
inline constexpr std::uint8_t kErrorUnderVoltage = 0x9;
inline constexpr std::uint8_t kErrorOverCurrent = 0xA;
inline constexpr std::uint8_t kErrorHotBoard = 0xB;
inline constexpr std::uint8_t kErrorHotCoil = 0xC;
inline constexpr std::uint8_t kErrorLostMaster = 0xD;
inline constexpr std::uint8_t kErrorOverload = 0xE;

/// The largest number of a motor: feedback carries four bits of it.
inline constexpr std::uint8_t kMotorIdMax = 15;

}  // namespace tenon::mit
