"""Variance that an aided navigator assumes for a single gyro reading."""

from ins_sim.core.numerics.units import DEG, DEG_H, SQRT_H


def rate_variance(settings):
    """
    Return the variance of the angular velocity about each axis, (rad/s)^2.

    It is the sum of the variances of the white noise of one sample and of the initial bias.
    settings: AidedNavigatorSettings.
    """
    model = settings.imu_model
    white = model.angle_random_walk_deg_sqrt_h * DEG / SQRT_H
    bias = model.gyro_bias_sigma_deg_h * DEG_H
    return white * white * settings.rate_hz + bias * bias
