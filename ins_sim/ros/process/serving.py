"""Serve callbacks in a node process that has its own loop."""

from rclpy.executors import TimeoutException

# Maximum number of callbacks per call; the others follow in the next call.
MOST = 50


def serve_ready(executor):
    """
    Run the callbacks that are ready, without waiting for others.

    This is faster than ``spin_once``, which rebuilds the wait set for each single callback.
    """
    try:
        for _ in range(MOST):
            task, _, _ = executor.wait_for_ready_callbacks(timeout_sec=0.0)
            task()
            if task.exception() is not None:
                raise task.exception()
    except TimeoutException:
        pass
