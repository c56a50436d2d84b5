(function () {
  'use strict';
  var all = function (what, inside) { return Array.from((inside || document).querySelectorAll(what)); };
  document.documentElement.classList.add('scripted');
  all('.copy, .js').forEach(function (one) { one.hidden = false; });

  // Copies a configuration, or selects it on a page that may not copy.
  var copied = function (button, text) {
    var before = button.textContent;
    button.textContent = text;
    setTimeout(function () { button.textContent = before; }, 1500);
  };
  var select = function (card, button) {
    card.open = true;
    card.scrollIntoView({ block: 'nearest' });
    getSelection().selectAllChildren(card.querySelector('pre'));
    copied(button, 'selected');
  };
  all('.copy').forEach(function (button) {
    button.addEventListener('click', function () {
      var card = document.getElementById('c' + button.dataset.copy);
      if (!navigator.clipboard) { select(card, button); return; }
      navigator.clipboard.writeText(card.querySelector('pre').textContent).then(
        function () { copied(button, 'copied'); }, function () { select(card, button); });
    });
  });

  // Opens the configuration that a link leads to.
  var open = function () {
    var card = document.getElementById(location.hash.slice(1));
    if (card ? card.tagName.toLowerCase() === 'details' : false) { card.open = true; }
  };
  addEventListener('hashchange', open);
  open();

  // Sorts by a column. Rows without a value stay last.
  all('table.sortable').forEach(function (table) {
    var heads = all('thead th', table);
    heads.forEach(function (head, column) {
      head.tabIndex = 0;
      var sort = function () {
        var down = head.getAttribute('aria-sort') === 'ascending';
        heads.forEach(function (other) { other.removeAttribute('aria-sort'); });
        head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
        var body = table.tBodies[0];
        var rows = all('tr', body).map(function (row) {
          var text = row.cells[column].dataset.v;
          return { row: row, text: text, number: text === '' ? NaN : Number(text) };
        });
        rows.sort(function (one, other) {
          if (one.text === '' || other.text === '') { return (one.text === '') - (other.text === ''); }
          var order = one.number - other.number;
          if (isNaN(order)) { order = one.text.localeCompare(other.text); }
          return down ? -order : order;
        });
        rows.forEach(function (one) { body.appendChild(one.row); });
      };
      head.addEventListener('click', sort);
      head.addEventListener('keydown', function (event) { if (event.key === 'Enter') { sort(); } });
    });
  });

{% if !page.script.is_empty() %}{{ page.script|safe }}

{% endif %}  // Shows that a table continues to the right.
  all('.wide').forEach(function (wide) {
    var inside = wide.querySelector('.scroll');
    var look = function () {
      var hidden = inside.scrollWidth - inside.clientWidth - inside.scrollLeft;
      wide.classList.toggle('more', hidden > 4);
    };
    inside.addEventListener('scroll', look, { passive: true });
    addEventListener('resize', look);
    look();
  });

  // Finds the mark nearest to a finger. Of several at the same distance it is the topmost.
  var REACH = 28;
  var nearest = function (figure, x, y) {
    var found = null;
    var least = REACH;
    all('a[data-n]', figure).forEach(function (link) {
      var box = link.querySelector('.mark').getBoundingClientRect();
      var away = Math.hypot(box.left + box.width / 2 - x, box.top + box.height / 2 - y);
      if (least >= away) { found = link; least = away; }
    });
    return found;
  };

  // Shows the figures of a mark below its plot, for fingers and keyboards, which cannot point at it.
  var tell = function (figure, link) {
    var tip = figure.querySelector('.tip');
    all('.here').forEach(function (one) { one.classList.remove('here'); });
    tip.hidden = !link;
    if (!link) { return; }
    var number = link.dataset.n;
    tip.textContent = link.querySelector('title').textContent + '\n';
    [{% for target in page.targets %}{% if !loop.first %}, {% endif %}['{{ target.prefix }}', '{{ target.name }}']{% endfor %}].forEach(function (target) {
      var to = document.createElement('a');
      to.href = '#' + target[0] + number;
      to.textContent = target[1];
      tip.appendChild(to);
    });
    all('[data-n="' + number + '"]').forEach(function (same) { same.classList.add('here'); });
  };
  var mouse = true;
  addEventListener('pointerdown', function (event) { mouse = event.pointerType === 'mouse'; }, true);
  addEventListener('keydown', function () { mouse = true; }, true);
  all('figure.plot').forEach(function (figure) {
    var picture = figure.querySelector('svg');
    picture.addEventListener('click', function (event) {
      if (mouse) { return; }
      event.preventDefault();
      tell(figure, nearest(figure, event.clientX, event.clientY));
    });
    picture.addEventListener('focusin', function (event) {
      var link = event.target.closest('a[data-n]');
      if (link ? link.matches(':focus-visible') : false) { tell(figure, link); }
    });
  });

  // Shows the same point in all plots.
  var show = function (on) {
    return function (event) {
      if (event.pointerType === 'touch') { return; }
      var one = event.target.closest('[data-n]');
      if (one) {
        all('[data-n="' + one.dataset.n + '"]').forEach(function (same) { same.classList.toggle('here', on); });
      }
    };
  };
  document.addEventListener('pointerover', show(true));
  document.addEventListener('pointerout', show(false));
}());
