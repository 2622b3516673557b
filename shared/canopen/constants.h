#pragma once
// Wire constants of CANopen (CiA 301) and of its drive profile (CiA 402): identifiers, object
// indices, bit masks. Numbers alone: master codecs live in hw, slave codecs in sim, written apart.

#include <cstdint>

namespace tenon::canopen {

// Function codes: COB-ID = base + node (CiA 301, 7.3.5).
inline constexpr std::uint32_t kNmt = 0x000;
inline constexpr std::uint32_t kSync = 0x080;
inline constexpr std::uint32_t kEmergency = 0x080;
inline constexpr std::uint32_t kTpdo1 = 0x180;
inline constexpr std::uint32_t kRpdo1 = 0x200;
inline constexpr std::uint32_t kTpdo2 = 0x280;
inline constexpr std::uint32_t kRpdo2 = 0x300;
inline constexpr std::uint32_t kSdoResponse = 0x580;
inline constexpr std::uint32_t kSdoRequest = 0x600;
inline constexpr std::uint32_t kHeartbeat = 0x700;
/// The identifier within a COB-ID's value (7.5.2).
inline constexpr std::uint32_t kIdMask = 0x7FF;

// NMT commands and states (7.2.8).
inline constexpr std::uint8_t kNmtStart = 0x01;
inline constexpr std::uint8_t kNmtStop = 0x02;
inline constexpr std::uint8_t kNmtPreOperational = 0x80;
inline constexpr std::uint8_t kNmtResetNode = 0x81;
inline constexpr std::uint8_t kNmtResetCommunication = 0x82;
inline constexpr std::uint8_t kStateBootUp = 0x00;
inline constexpr std::uint8_t kStateStopped = 0x04;
inline constexpr std::uint8_t kStateOperational = 0x05;
inline constexpr std::uint8_t kStatePreOperational = 0x7F;

// SDO abort codes (7.2.4.3.17).
inline constexpr std::uint32_t kAbortToggle = 0x05030000;
inline constexpr std::uint32_t kAbortTimeout = 0x05040000;
inline constexpr std::uint32_t kAbortCommand = 0x05040001;
inline constexpr std::uint32_t kAbortWriteOnly = 0x06010001;
inline constexpr std::uint32_t kAbortReadOnly = 0x06010002;
inline constexpr std::uint32_t kAbortNoObject = 0x06020000;
inline constexpr std::uint32_t kAbortNotMappable = 0x06040041;
inline constexpr std::uint32_t kAbortMappingTooLong = 0x06040042;
inline constexpr std::uint32_t kAbortLength = 0x06070010;
inline constexpr std::uint32_t kAbortLengthHigh = 0x06070012;
inline constexpr std::uint32_t kAbortLengthLow = 0x06070013;
inline constexpr std::uint32_t kAbortSubIndex = 0x06090011;
inline constexpr std::uint32_t kAbortValue = 0x06090030;
inline constexpr std::uint32_t kAbortValueHigh = 0x06090031;
inline constexpr std::uint32_t kAbortValueLow = 0x06090032;
inline constexpr std::uint32_t kAbortDeviceState = 0x08000022;

// Communication profile objects.
inline constexpr std::uint16_t kDeviceType = 0x1000;
inline constexpr std::uint16_t kErrorRegister = 0x1001;
inline constexpr std::uint16_t kSyncCobId = 0x1005;
inline constexpr std::uint16_t kSyncPeriod = 0x1006;
inline constexpr std::uint16_t kSyncWindow = 0x1007;
inline constexpr std::uint16_t kStoreParameters = 0x1010;
inline constexpr std::uint16_t kHeartbeatConsumer = 0x1016;
inline constexpr std::uint16_t kHeartbeatProducer = 0x1017;
inline constexpr std::uint16_t kIdentity = 0x1018;
inline constexpr std::uint16_t kSyncOverflow = 0x1019;
inline constexpr std::uint16_t kRpdoCommunication = 0x1400;
inline constexpr std::uint8_t kPdoEventTimer = 5;  ///< sub-index; of an RPDO: its deadline, ms
inline constexpr std::uint16_t kRpdoMapping = 0x1600;
inline constexpr std::uint16_t kTpdoCommunication = 0x1800;
inline constexpr std::uint16_t kTpdoMapping = 0x1A00;
/// 512 PDOs each way have their parameters in a row.
inline constexpr std::uint16_t kPdos = 0x200;
[[nodiscard]] constexpr bool is_rpdo_mapping(std::uint32_t index) {
  return index >= kRpdoMapping && index < kRpdoMapping + kPdos;
}
[[nodiscard]] constexpr bool is_tpdo_mapping(std::uint32_t index) {
  return index >= kTpdoMapping && index < kTpdoMapping + kPdos;
}
inline constexpr std::uint32_t kPdoInvalid = 0x80000000;  ///< bit 31 of a PDO's COB-ID
inline constexpr std::uint32_t kPdoNoRtr = 0x40000000;

// Emergency error codes.
inline constexpr std::uint16_t kEmergencyReset = 0x0000;
inline constexpr std::uint16_t kEmergencyOverrun = 0x8110;
inline constexpr std::uint16_t kEmergencyErrorPassive = 0x8120;
inline constexpr std::uint16_t kEmergencyHeartbeat = 0x8130;
inline constexpr std::uint16_t kEmergencyBusOffRecovered = 0x8140;
inline constexpr std::uint16_t kEmergencyPdoLength = 0x8210;
inline constexpr std::uint16_t kEmergencySyncLength = 0x8240;
inline constexpr std::uint16_t kEmergencyRpdoTimeout = 0x8250;
inline constexpr std::uint16_t kEmergencyFollowingError = 0x8611;

// Drive profile objects.
inline constexpr std::uint16_t kAbortConnectionOption = 0x6007;
inline constexpr std::uint16_t kErrorCode = 0x603F;
inline constexpr std::uint16_t kControlword = 0x6040;
inline constexpr std::uint16_t kStatusword = 0x6041;
inline constexpr std::uint16_t kQuickStopOption = 0x605A;
inline constexpr std::uint16_t kShutdownOption = 0x605B;
inline constexpr std::uint16_t kDisableOption = 0x605C;
inline constexpr std::uint16_t kFaultReactionOption = 0x605E;
inline constexpr std::uint16_t kMode = 0x6060;
inline constexpr std::uint16_t kModeDisplay = 0x6061;
inline constexpr std::uint16_t kPositionActual = 0x6064;
inline constexpr std::uint16_t kFollowingWindow = 0x6065;
inline constexpr std::uint16_t kFollowingTimeout = 0x6066;
inline constexpr std::uint16_t kVelocityActual = 0x606C;
inline constexpr std::uint16_t kTorqueMax = 0x6072;
inline constexpr std::uint16_t kTorqueActual = 0x6077;
inline constexpr std::uint16_t kTargetPosition = 0x607A;
inline constexpr std::uint16_t kPositionLimits = 0x607D;  ///< sub 1 lowest, 2 highest
inline constexpr std::uint16_t kQuickStopDeceleration = 0x6085;
inline constexpr std::uint16_t kInterpolationData = 0x60C1;
inline constexpr std::uint16_t kInterpolationPeriod = 0x60C2;
inline constexpr std::uint16_t kSupportedModes = 0x6502;

// Controlword commands and bits.
inline constexpr std::uint16_t kCommandDisableVoltage = 0x0000;
inline constexpr std::uint16_t kCommandQuickStop = 0x0002;
inline constexpr std::uint16_t kCommandShutdown = 0x0006;
inline constexpr std::uint16_t kCommandSwitchOn = 0x0007;
inline constexpr std::uint16_t kCommandEnableOperation = 0x000F;
inline constexpr std::uint16_t kControlInterpolate = 0x0010;  ///< mode 7
inline constexpr std::uint16_t kControlFaultReset = 0x0080;   ///< acts on its rising edge

// Statusword: (word & mask) == value.
inline constexpr std::uint16_t kStatusMaskShort = 0x004F;
inline constexpr std::uint16_t kStatusMaskLong = 0x006F;
inline constexpr std::uint16_t kStatusNotReady = 0x0000;          // short mask
inline constexpr std::uint16_t kStatusSwitchOnDisabled = 0x0040;  // short mask
inline constexpr std::uint16_t kStatusReadyToSwitchOn = 0x0021;   // long mask
inline constexpr std::uint16_t kStatusSwitchedOn = 0x0023;        // long mask
inline constexpr std::uint16_t kStatusOperationEnabled = 0x0027;  // long mask
inline constexpr std::uint16_t kStatusQuickStopActive = 0x0007;   // long mask
inline constexpr std::uint16_t kStatusFaultReaction = 0x000F;     // short mask
inline constexpr std::uint16_t kStatusFault = 0x0008;             // short mask
inline constexpr std::uint16_t kStatusWarning = 0x0080;
inline constexpr std::uint16_t kStatusFollowingError = 0x2000;  ///< mode 8

// Modes of operation.
inline constexpr std::int8_t kModeInterpolatedPosition = 7;
inline constexpr std::int8_t kModeCyclicSynchronousPosition = 8;

// Force/torque node: manufacturer-specific input objects mapped into its two TPDOs.
inline constexpr std::uint16_t kForceInputs = 0x6401;    ///< sub 1..3 force x y z, 4..6 torque, i16
inline constexpr std::uint16_t kSampleCounter = 0x2001;  ///< u16, one more with every sample
inline constexpr std::uint16_t kSensorStatus = 0x2002;   ///< u16, 0 is good

}  // namespace tenon::canopen
