# SPDX-License-Identifier: BSD-3-Clause
"""Training libraries learn on vector environments as these are, where the libraries are installed."""

from __future__ import annotations

import gymnasium as gym
import numpy as np
import pytest

import sitl.envs
from sitl.envs import PAPER

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore"),  # of the libraries
]
SCAN = {"observation": "scan", "max_episode_steps": 40}
CONTINUOUS = {**SCAN, "action": "continuous", "world": "maze", "start": "random"}


def weights(module):
    return [values.detach().numpy().copy() for values in module.parameters()]


def has_learnt(before, after):
    return all(np.isfinite(b).all() for b in after) and any(not np.array_equal(a, b) for a, b in zip(before, after))


@pytest.mark.parametrize("name", [*PAPER, "sitl/Navigate-v0"])
def test_stable_baselines3(name):
    library = pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    from sitl.envs.sb3 import Sb3VecEnv

    env = Sb3VecEnv(name, num_envs=8, max_episode_steps=20)
    model = library.PPO("MlpPolicy", env, n_steps=32, batch_size=64, n_epochs=2, seed=1, device="cpu")
    before = weights(model.policy)
    model.learn(512)  # twice: with what it has learnt, too
    assert model.num_timesteps == 512 and has_learnt(before, weights(model.policy))
    env.close()


@pytest.mark.parametrize("algorithm", ["DQN", "A2C", "SAC", "TD3"])
def test_other_algorithms_of_stable_baselines3(algorithm):
    library = pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    from sitl.envs.sb3 import Sb3VecEnv

    options = CONTINUOUS if algorithm in ("SAC", "TD3") else SCAN
    env = Sb3VecEnv("sitl/Navigate-v0", num_envs=8, **options)
    replay = {} if algorithm == "A2C" else {"learning_starts": 100, "buffer_size": 1000}
    model = getattr(library, algorithm)("MlpPolicy", env, seed=1, device="cpu", **replay)
    before = weights(model.policy)
    model.learn(800)
    assert has_learnt(before, weights(model.policy))
    env.close()


@pytest.mark.parametrize(
    ("algorithm", "name"),
    [
        ("PPO", "sitl/CopterHoverDiscrete-v0"),
        ("PPO", "sitl/CopterHover-v0"),
        ("DQN", "sitl/RoverWaypointDiscrete-v0"),
        ("SAC", "sitl/RoverWaypoint-v0"),
        ("TQC", "sitl/CopterHover-v0"),
    ],
)
def test_stable_baselines3_with_single_environments_by_id(algorithm, name):
    """As its first page shows: a class and an id."""
    library = pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    if algorithm == "TQC":
        library = pytest.importorskip("sb3_contrib", reason="needs sb3-contrib")
    off_policy = {"learning_starts": 50, "buffer_size": 1000, "batch_size": 32}
    settings = {"n_steps": 128, "batch_size": 64, "n_epochs": 2} if algorithm == "PPO" else off_policy
    model = getattr(library, algorithm)("MlpPolicy", f"sitl.envs:{name}", seed=1, device="cpu", **settings)
    before = weights(model.policy)
    model.learn(256)
    assert has_learnt(before, weights(model.policy))
    model.get_env().close()


@pytest.mark.parametrize("many", [False, True])
@pytest.mark.parametrize(
    ("algorithm", "name"),
    [("SAC", "sitl/CopterReachGoal-v0"), ("TQC", "sitl/RoverReachGoal-v0"), ("DQN", "sitl/CopterReachGoalDiscrete-v0")],
)
def test_hindsight_replay_of_stable_baselines3(algorithm, name, many):
    library = pytest.importorskip("stable_baselines3", reason="needs the extra 'rl'")
    if algorithm == "TQC":
        library = pytest.importorskip("sb3_contrib", reason="needs sb3-contrib")
    from stable_baselines3 import HerReplayBuffer

    from sitl.envs.sb3 import Sb3VecEnv

    env = Sb3VecEnv(name, 4, max_episode_steps=20) if many else gym.make(name, max_episode_steps=20)
    model = getattr(library, algorithm)(
        "MultiInputPolicy", env, replay_buffer_class=HerReplayBuffer, seed=1, device="cpu", learning_starts=100,
        buffer_size=1000, batch_size=64, replay_buffer_kwargs={"n_sampled_goal": 4, "goal_selection_strategy": "final"},
    )  # fmt: skip
    before = weights(model.policy)
    model.learn(200)
    assert has_learnt(before, weights(model.policy))
    batch = model.replay_buffer.sample(200)
    there = np.linalg.norm(batch.next_observations["achieved_goal"] - batch.observations["desired_goal"], axis=1)
    assert np.array_equal(batch.rewards.numpy()[:, 0] == 0.0, there < 1.0), "rewards are those of the goals put in"
    assert (batch.rewards == 0.0).any(), "some goals were reached in hindsight"
    env.close()


@pytest.mark.parametrize("name", ["sitl/Navigate-v0", "GazeboOfficeErleCopterLIDAR-v0"])
def test_a_loop_in_one_file(name):
    """PPO as CleanRL has it: a vector environment that resets in the next step, arrays of all robots, one update."""
    torch = pytest.importorskip("torch", reason="needs the extra 'rl'")
    torch.manual_seed(0)
    envs = gym.wrappers.vector.RecordEpisodeStatistics(gym.make_vec(name, num_envs=8, **SCAN))
    width, steps = int(np.prod(envs.single_observation_space.shape)), 64

    def net(out):
        return torch.nn.Sequential(torch.nn.Linear(width, 32), torch.nn.Tanh(), torch.nn.Linear(32, out))

    actor, critic = net(int(envs.single_action_space.n)), net(1)
    before = weights(actor), weights(critic)
    optimiser = torch.optim.Adam([*actor.parameters(), *critic.parameters()], 1e-3)
    seen, taken, paid, done = [], [], [], []
    observation, _ = envs.reset(seed=1)
    episodes, ended = 0, np.zeros(8, np.bool_)
    for _ in range(steps):
        row = torch.as_tensor(observation)
        action = torch.distributions.Categorical(logits=actor(row).detach()).sample()
        seen.append(row), taken.append(action), done.append(torch.as_tensor(ended))
        observation, reward, terminated, truncated, infos = envs.step(action.numpy())
        paid.append(torch.as_tensor(reward, dtype=torch.float32))
        ended = terminated | truncated
        episodes += int(infos["_episode"].sum()) if "episode" in infos else 0
    rows, actions = torch.stack(seen), torch.stack(taken)
    with torch.no_grad():
        values = critic(rows)[..., 0]
        value, following, returns = critic(torch.as_tensor(observation))[:, 0], torch.as_tensor(ended), []
        for t in reversed(range(steps)):
            value = paid[t] + 0.99 * value * ~following
            following = done[t]
            returns.insert(0, value)
    goal = torch.stack(returns)
    chances = torch.distributions.Categorical(logits=actor(rows)).log_prob(actions)
    ratio = (chances - chances.detach()).exp()
    loss = -(ratio * (goal - values)).mean() + 0.5 * ((critic(rows)[..., 0] - goal) ** 2).mean()
    optimiser.zero_grad(), loss.backward(), optimiser.step()
    assert episodes > 0 and has_learnt(before[0], weights(actor)) and has_learnt(before[1], weights(critic))
    envs.close()


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("sitl/Navigate-v0", SCAN),
        ("sitl/Navigate-v0", CONTINUOUS),
        ("GazeboMazeErleRoverLIDAR-v0", SCAN),
        ("sitl/CopterHoverDiscrete-v0", {}),
        ("sitl/CopterHover-v0", {}),
        ("sitl/CopterReachGoal-v1", {}),
        ("sitl/CopterHover-v1", {"observation": "camera+velocity"}),
    ],
)
def test_skrl(tmp_path, name, options):
    pytest.importorskip("skrl", reason="needs skrl")
    torch = pytest.importorskip("torch", reason="needs the extra 'rl'")
    from skrl.agents.torch.ppo import PPO, PPO_CFG
    from skrl.envs.wrappers.torch import wrap_env
    from skrl.memories.torch import RandomMemory
    from skrl.models.torch import CategoricalMixin, DeterministicMixin, GaussianMixin, Model
    from skrl.trainers.torch import SequentialTrainer

    env = wrap_env(gym.make_vec(name, num_envs=8, **options), wrapper="gymnasium")
    discrete = isinstance(env.action_space, gym.spaces.Discrete)
    where = {"observation_space": env.observation_space, "action_space": env.action_space, "device": env.device}

    def body(model, out):
        model.net = torch.nn.Sequential(torch.nn.Linear(model.num_observations, 32), torch.nn.Tanh(),
                                        torch.nn.Linear(32, out))  # fmt: skip

    class Policy(CategoricalMixin if discrete else GaussianMixin, Model):
        def __init__(self):
            Model.__init__(self, **where)
            (CategoricalMixin if discrete else GaussianMixin).__init__(self)
            body(self, self.num_actions)
            self.log_std = torch.nn.Parameter(torch.full((self.num_actions,), -1.0))

        def compute(self, inputs, role):
            out = self.net(inputs["observations"].float())
            return (out, {}) if discrete else (out, {"log_std": self.log_std})

    class Value(DeterministicMixin, Model):
        def __init__(self):
            Model.__init__(self, **where)
            DeterministicMixin.__init__(self)
            body(self, 1)

        def compute(self, inputs, role):
            return self.net(inputs["observations"].float()), {}

    models = {"policy": Policy(), "value": Value()}
    config = PPO_CFG()
    config.rollouts, config.learning_epochs, config.mini_batches = 16, 2, 2
    config.experiment.directory, config.experiment.write_interval = str(tmp_path), 0
    config.experiment.checkpoint_interval = 0
    agent = PPO(models=models, memory=RandomMemory(memory_size=16, num_envs=8, device=env.device), cfg=config,
                observation_space=env.observation_space, action_space=env.action_space, device=env.device)  # fmt: skip
    before = weights(models["value"])
    SequentialTrainer(
        cfg={"timesteps": 64, "headless": True, "disable_progressbar": True, "close_environment_at_exit": False},
        env=env,
        agents=agent,
    ).train()
    assert has_learnt(before, weights(models["value"]))


@pytest.mark.parametrize("many", [False, True], ids=["single", "vector"])
@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("sitl/Navigate-v0", SCAN),
        ("sitl/Navigate-v0", CONTINUOUS),
        ("GazeboMazeErleRoverLIDAR-v0", {"observation": ["digits"]}),
        ("sitl/CopterHoverDiscrete-v0", {}),
        ("sitl/CopterHover-v0", {}),
    ],
)
def test_rllib(name, options, many):
    """By the id alone, which RLlib makes as often as it needs it, and by the vector environment behind the id."""
    pytest.importorskip("ray.rllib", reason="needs ray[rllib]")
    from ray.rllib.algorithms.ppo import PPOConfig

    runners = {"num_envs_per_env_runner": 8, "gym_env_vectorize_mode": "vector_entry_point"} if many else {}
    config = (
        PPOConfig()
        .environment(f"{sitl.envs.__name__}:{name}", env_config=options)
        .env_runners(num_env_runners=0, **runners)
        .training(train_batch_size=512, minibatch_size=128, num_epochs=2)
        .debugging(seed=1)
    )
    algorithm = config.build_algo()
    try:
        assert type(algorithm.env_runner.env.unwrapped).__name__.endswith("Vector") == many
        result = algorithm.train()
        assert result["env_runners"]["num_env_steps_sampled"] >= 512
        assert np.isfinite(result["learners"]["default_policy"]["total_loss"])
    finally:
        algorithm.stop()


@pytest.mark.parametrize("name", ["sitl/CopterHoverDiscrete-v0", "sitl/CopterHover-v0"])
def test_tianshou(name):
    pytest.importorskip("tianshou", minversion="2", reason="needs tianshou 2")
    from tianshou.algorithm import DQN, SAC
    from tianshou.algorithm.modelfree.dqn import DiscreteQLearningPolicy
    from tianshou.algorithm.modelfree.sac import SACPolicy
    from tianshou.algorithm.optim import AdamOptimizerFactory
    from tianshou.data import Collector, VectorReplayBuffer
    from tianshou.env import DummyVectorEnv
    from tianshou.trainer import OffPolicyTrainerParams
    from tianshou.utils.net.common import Net
    from tianshou.utils.net.continuous import ContinuousActorProbabilistic, ContinuousCritic

    envs = DummyVectorEnv([lambda: gym.make(name, max_episode_steps=20) for _ in range(2)])
    space, seen = envs.action_space[0], envs.observation_space[0].shape
    optimiser = AdamOptimizerFactory(lr=1e-3)
    if isinstance(space, gym.spaces.Discrete):
        net = Net(state_shape=seen, action_shape=space.n, hidden_sizes=[32])
        policy = DiscreteQLearningPolicy(model=net, action_space=space, eps_training=0.5)
        algorithm = DQN(policy=policy, optim=optimiser, target_update_freq=50)
    else:
        actor = ContinuousActorProbabilistic(
            preprocess_net=Net(state_shape=seen, hidden_sizes=[32]), action_shape=space.shape, unbounded=True,
            conditioned_sigma=True,
        )  # fmt: skip
        both = Net(state_shape=seen, action_shape=space.shape, hidden_sizes=[32], concat=True)
        algorithm = SAC(
            policy=SACPolicy(actor=actor, action_space=space), policy_optim=optimiser,
            critic=ContinuousCritic(preprocess_net=both), critic_optim=optimiser,
        )  # fmt: skip
    before = weights(algorithm)
    collector = Collector(algorithm, envs, VectorReplayBuffer(1000, 2), exploration_noise=True)
    collector.reset()
    plan = OffPolicyTrainerParams(
        training_collector=collector, max_epochs=1, epoch_num_steps=200, collection_step_num_env_steps=20,
        update_step_num_gradient_steps_per_sample=0.2, batch_size=32, show_progress=False,
    )  # fmt: skip
    algorithm.run_training(plan)
    assert has_learnt(before, weights(algorithm))
    envs.close()


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("sitl/CopterHover-v1", {}),
        ("sitl/CopterHoverDiscrete-v1", {}),
        ("sitl/CopterReachGoal-v1", {}),
        ("sitl/CopterHover-v1", {"observation": "camera+velocity"}),
    ],
)
def test_torchrl(name, options):
    """By the id alone; it asks for a ``frameskip`` first."""
    gyms = pytest.importorskip("torchrl.envs", reason="needs torchrl")
    env = gyms.GymEnv(f"sitl.envs:{name}", **options)
    gyms.check_env_specs(env)
    played = env.rollout(20, break_when_any_done=False)
    assert played.shape == (20,) and np.isfinite(played["next", "reward"].numpy()).all()
    env.close()


def test_torchrl_takes_vectors():
    gyms = pytest.importorskip("torchrl.envs", reason="needs torchrl")
    robots = gym.make_vec("sitl/CopterHover-v1", num_envs=4, max_episode_steps=5, autoreset_mode="SameStep")
    env = gyms.GymWrapper(robots)
    played = env.rollout(12, break_when_any_done=False)
    assert played.shape == (4, 12) and played["next", "truncated"].sum() == 8
    env.close()


@pytest.mark.parametrize(
    ("algorithm", "name"), [("SACConfig", "sitl/CopterHover-v1"), ("DQNConfig", "sitl/CopterHoverDiscrete-v1")]
)
def test_d3rlpy(algorithm, name):
    library = pytest.importorskip("d3rlpy", reason="needs d3rlpy")
    env = gym.make(name, max_episode_steps=20)
    agent = getattr(library.algos, algorithm)(batch_size=16).create(device="cpu")
    buffer = library.dataset.create_fifo_replay_buffer(limit=200, env=env)
    silent = library.logging.NoopAdapterFactory()
    agent.fit_online(env, buffer, n_steps=50, n_steps_per_epoch=50, update_start_step=45, show_progress=False,
                     logger_adapter=silent)  # fmt: skip
    assert buffer.transition_count >= 40
    env.close()


@pytest.mark.parametrize("name", ["sitl/CopterHover-v1", "sitl/CopterHoverDiscrete-v1", "sitl/CopterReachGoal-v1"])
def test_emulation_of_pufferlib(name):
    pytest.importorskip("pufferlib", reason="needs PufferLib")
    from pufferlib import vector
    from pufferlib.emulation import GymnasiumPufferEnv

    def creator(buf=None, seed=0):
        return GymnasiumPufferEnv(env_creator=gym.make, env_args=[name], buf=buf, seed=seed)

    envs = vector.make(creator, num_envs=2, backend=vector.Serial)
    envs.reset(seed=0)
    for _ in range(3):
        observations, rewards, *_ = envs.step(envs.action_space.sample())
    assert np.isfinite(rewards).all()
    assert observations.shape == (2, *envs.single_observation_space.shape)
