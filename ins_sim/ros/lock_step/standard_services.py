"""
Services of the package simulation_interfaces on the generator, if that package is installed.

They are ~/get_simulator_features, ~/get_simulation_state, ~/set_simulation_state,
~/step_simulation and ~/reset_simulation, in addition to the services of std_srvs.
"""

from importlib import import_module
from importlib.util import find_spec

PACKAGE = 'simulation_interfaces'
FEATURES = ('SIMULATION_RESET', 'SIMULATION_RESET_TIME', 'SIMULATION_RESET_STATE',
            'SIMULATION_STATE_GETTING', 'SIMULATION_STATE_SETTING', 'SIMULATION_STATE_PAUSE',
            'STEP_SIMULATION_SINGLE', 'STEP_SIMULATION_MULTIPLE')
# Maximum number of steps in one call.
MOST_STEPS = 1_000_000


def offer_standard_services(generator):
    """Add the services to a MotionGeneratorNode, if the package is installed."""
    if find_spec(PACKAGE) is None:
        return
    try:
        msg, srv = import_module(f'{PACKAGE}.msg'), import_module(f'{PACKAGE}.srv')
        services = StandardServices(generator, msg)
        for name in ('get_simulator_features', 'get_simulation_state', 'set_simulation_state',
                     'step_simulation', 'reset_simulation'):
            kind = getattr(srv, ''.join(map(str.capitalize, name.split('_'))))
            generator.create_service(kind, f'~/{name}', getattr(services, name))
    except (ImportError, AttributeError, RuntimeError) as error:
        generator.get_logger().warning(
            f'{PACKAGE} is installed but cannot be used ({error}); expected release 1.2 or later: '
            'its services are not offered')


class StandardServices:
    """
    Answers the service requests by pausing, stepping and resetting the generator.

    State *stopped* means paused at sample 0 after a request to stop; a finished run is *paused*.

    Parameters
    ----------
    generator : MotionGeneratorNode
    msg : module with Result, SimulationState and SimulatorFeatures
    """

    def __init__(self, generator, msg):
        self._generator, self._stopped = generator, False
        self._codes, self._states, self._features = (msg.Result, msg.SimulationState,
                                                     msg.SimulatorFeatures)

    def _answer(self, response, sentence='', code=None):
        """Fill in the result: success if there is no error sentence, else an error code."""
        codes = self._codes
        response.result.error_message = sentence
        response.result.result = codes.RESULT_OK if not sentence else (
            codes.RESULT_OPERATION_FAILED if code is None else code)
        return response

    @property
    def _state(self):
        generator, states = self._generator, self._states
        if generator.monitor.state == 'running':
            return states.STATE_PLAYING
        return states.STATE_STOPPED if self._stopped else states.STATE_PAUSED

    def get_simulator_features(self, request, response):
        """Return the supported features."""
        response.features.features = [getattr(self._features, name) for name in FEATURES
                                      if hasattr(self._features, name)]
        response.features.custom_info = 'ins_sim: truth, IMU and inertial navigation'
        return response

    def get_simulation_state(self, request, response):
        """Return stopped, playing or paused."""
        response.state.state = self._state
        return self._answer(response)

    def set_simulation_state(self, request, response):
        """Pause, play, stop or quit."""
        generator, states, wanted = self._generator, self._states, request.state.state
        known = {states.STATE_STOPPED, states.STATE_PLAYING, states.STATE_PAUSED,
                 states.STATE_QUITTING}
        if wanted not in known:
            return self._answer(response, f'the state {wanted} cannot be set; expected stopped, '
                                'playing, paused or quitting',
                                self._codes.RESULT_FEATURE_UNSUPPORTED)
        if wanted == states.STATE_QUITTING:
            generator.end()
            return self._answer(response)
        if wanted == self._state:
            return self._answer(response, 'the simulation is already in that state',
                                type(response).ALREADY_IN_TARGET_STATE)
        if wanted == states.STATE_STOPPED:
            generator.pause(True)
            generator.reset()
        elif generator.monitor.state == 'finished':
            return self._answer(response, 'the run has finished; expected a reset',
                                type(response).STATE_TRANSITION_ERROR)
        else:
            generator.pause(wanted == states.STATE_PAUSED)
        self._stopped = wanted == states.STATE_STOPPED
        return self._answer(response)

    def step_simulation(self, request, response):
        """Send samples of the truth while paused; return when they are sent."""
        generator = self._generator
        state = generator.monitor.state
        if state != 'paused':
            return self._answer(response, f'the simulation is {state}; expected paused',
                                self._codes.RESULT_OPERATION_FAILED)
        if not 1 <= request.steps <= MOST_STEPS:
            return self._answer(response, f'steps is {request.steps}; expected 1 to {MOST_STEPS}')
        self._stopped = False
        sent = generator.send(request.steps)
        if sent < request.steps:
            return self._answer(response, f'{sent} of {request.steps} steps were made: the run '
                                'has ended, or a consumer of pacing.required is late')
        return self._answer(response)

    def reset_simulation(self, request, response):
        """Go back to sample 0; the run stays paused or playing as it was."""
        request_class = type(request)
        scope = request.scope or request_class.SCOPE_ALL
        if not scope & (request_class.SCOPE_TIME | request_class.SCOPE_STATE):
            return self._answer(response, 'the scope contains neither time nor state; expected at '
                                'least one of them', self._codes.RESULT_FEATURE_UNSUPPORTED)
        self._generator.reset()
        return self._answer(response)
