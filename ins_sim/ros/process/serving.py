"""Callbacks of nodes whose process has a loop of its own."""

from rclpy.executors import TimeoutException

# Of the callbacks that are ready, so many run at once; the others follow the next time.
MOST = 50


def serve_ready(executor):
    """
    Run the callbacks that are ready, without waiting for others.

    ``spin_once`` runs one of them, and gathers all that could be ready again for the next one.
    """
    try:
        for _ in range(MOST):
            task, _, _ = executor.wait_for_ready_callbacks(timeout_sec=0.0)
            task()
            if task.exception() is not None:
                raise task.exception()
    except TimeoutException:
        pass
