"""Messages to the user, on sys.stdout, so that Python can redirect them."""


def say(messages):
    for message in messages:
        print(message)


def warn(number, text):
    print(f"WARN{number}: Warning, {text}")
