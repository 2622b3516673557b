"""The messages of a run that never was: what each says is known to the digit."""
import time


class MadeUpRun:
    """Seven joints, three steps; a push along x just below its threshold."""
    JOINTS = ["shoulder_pan", "shoulder_lift", "elbow", "wrist_1", "wrist_2", "wrist_3", "rail"]
    RUNNING, FINISHED, QUICK_STOPPING = 3, 8, 5
    FORCE_FAULT, PLAN_DONE = 11, 1

    def __init__(self, publisher):
        self.publisher = publisher
        self.cycles = 0
        self.setups = 0
        self.state = self.RUNNING
        self.end_reason = 0
        self.wrench = [5.2, -1.0, 0.0, 0.01, 0.0, -0.30]
        self.pose = [0.0, 0.0, 0.0]

    def now(self, message):
        message.utime = int(time.time() * 1e6)
        message.monotonic_ns = time.monotonic_ns()
        return message

    def setup(self):
        from tenon.run_setup_t import run_setup_t
        m = self.now(run_setup_t())
        m.sequence, self.setups = self.setups, self.setups + 1
        m.cycle_s, m.force_fault_N, m.torque_fault_Nm, m.force_limit_N, m.torque_limit_Nm = 0.002, 60.0, 10.0, 20.0, 2.0
        m.bus_load_most, m.compliant_axes = 0.85, 0x3F
        m.plan, m.start, m.cell, m.robot = "made_up_plan", "left", "bench", "arm_on_rail"
        m.joint_count, m.joint_names = 7, "".join(name + "\n" for name in self.JOINTS)
        m.joint_linear = [False] * 6 + [True]
        m.joint_lower, m.joint_upper = [-2.0] * 6 + [0.0], [2.0] * 6 + [1.0]
        m.step_count = 3
        m.displacement = [[0.1, 0, 0, 0, 0, 0], [0, 0, -0.05, 0, 0, 0], [0, 0, 0, 0, 0, 0.2]]
        m.expected, m.expected_from, m.expected_to = [2, 3, 1], [0.03, 0.01, 0.2], [0.08, 0.05, 0.2]
        m.force_on_N, m.torque_on_Nm, m.timeout_s = [6.0] * 3, [0.6] * 3, [10.0] * 3
        m.trigger_mask, m.sensed_axes = [0xFFF] * 3, [0x3F] * 3
        self.publisher.publish("TENON_SETUP", m)

    def cycle(self):
        from tenon.cycle_state_t import cycle_state_t
        m = self.now(cycle_state_t())
        m.sequence, self.cycles = self.cycles, self.cycles + 1
        m.motion_ns = 2_000_000 * self.cycles
        m.state, m.arm_state, m.end_reason = self.state, 3, self.end_reason
        # The first cycle stands before the plan.
        m.step = -1 if m.sequence == 0 or self.state == self.FINISHED else 0
        m.signature = 0b1000 if self.end_reason == 0 else 0  # -y
        m.pose_position_m, m.pose_orientation_wxyz[0] = self.pose, 1.0
        m.wrench, m.wrench_fresh = self.wrench, True
        m.joint_count, m.joints_fresh = 7, 0x7F
        m.joint_position = [0.0, 1.0, -1.95, 0.5, -0.5, 1.5, 0.25]
        m.joint_commanded = m.joint_position
        m.wakeup_late_s, m.compute_s, m.late_cycles = 0.00005, 0.00012, 4
        self.publisher.publish("TENON_CYCLE", m)

    def status(self):
        from tenon.run_status_t import run_status_t
        m = self.now(run_status_t())
        m.awaited_step, m.pace, m.slipped_joint = -1, 1.0, -1
        m.bus_known, m.bus_up = True, True
        m.bus_load, m.bus_load_worst, m.frame_rate_hz, m.send_failures = 0.44, 0.54, 4533.0, 2
        self.publisher.publish("TENON_STATUS", m)

    def step(self):
        from tenon.step_event_t import step_event_t
        m = self.now(step_event_t())
        m.step, m.outcome, m.signature, m.successor = 0, 1, 2, 1
        m.travelled, m.peak_force_N, m.duration_s = [0.0312, 0, 0, 0, 0, 0], 14.5, 1.42
        self.publisher.publish("TENON_STEP", m)

    def summary(self, exit_code, reason, message):
        from tenon.run_summary_t import run_summary_t
        m = self.now(run_summary_t())
        m.plan, m.exit_code, m.end_reason, m.message = "made_up_plan", exit_code, reason, message
        self.publisher.publish("TENON_RUN", m)

    def begin(self):
        self.setup()
        self.cycle()
        self.pose = [0.0, 0.0, 0.0]
        self.cycle()
        self.pose = [0.0425, 0.0, 0.0]
        self.step()

    def go_on(self, seconds, read):
        """Publishes and reads for so long."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.setup()
            self.status()
            for _ in range(10):
                self.cycle()
                read(0.005)
