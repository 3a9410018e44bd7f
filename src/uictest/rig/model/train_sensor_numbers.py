"""The second source of speed and the accelerometer in the parameter record; zeros without them."""

from uictest.core.record import Record, derived


class TrainSensor(Record):
    """What a case fixes of them: :mod:`uictest.rig.model.train_sensors`."""

    has_train_speed: float = derived()  # 0 or 1; where 0, the next four are zero
    train_speed_period: int = derived()  # controller cycles
    train_speed_delay: int = derived()  # controller cycles
    train_speed_noise: float = derived()  # m/s
    train_speed_gain_error: float = derived()
    has_accelerometer: float = derived()  # 0 or 1; where 0, the next two are zero
    accelerometer_noise: float = derived()  # m/s2
    accelerometer_offset: float = derived()  # m/s2
