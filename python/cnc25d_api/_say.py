"""Messages to the user, through Python's own stream (so that redirecting it works)."""


def say(messages):
    for message in messages:
        print(message)


def warn(number, text):
    print(f"WARN{number}: Warning, {text}")
