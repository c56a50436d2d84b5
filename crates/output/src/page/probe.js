// Runs in the page, in Chromium, and reports what a reader with a mouse or a finger would find.
addEventListener('load', function () {
  document.documentElement.style.scrollBehavior = 'auto';
  var found = {};
  // Tables that are cut, and a page that is wider than the window.
  found.cut = document.querySelectorAll('.wide.more').length;
  found.wider = Number(document.documentElement.scrollWidth > innerWidth);
  // Rows that are under the headings, or out of sight, after a mark leads to them.
  found.rows = 0;
  found.hidden = 0;
  Array.from(document.querySelectorAll('tbody tr[id^="p"]')).reverse().forEach(function (row) {
    location.hash = '#' + row.id;
    var head = row.closest('table').querySelector('thead th').getBoundingClientRect();
    var inside = row.closest('.scroll').getBoundingClientRect();
    var box = row.getBoundingClientRect();
    var low = Math.min(inside.bottom, innerHeight) + 1;
    found.rows += 1;
    found.hidden += Number(head.bottom > box.top + 1 || 0 > box.top || box.bottom > low);
  });
  // Figures that a finger near a mark brings up.
  found.plots = 0;
  found.told = 0;
  document.querySelectorAll('figure.plot').forEach(function (figure) {
    var marks = figure.querySelectorAll('.mark');
    var box = marks[marks.length - 1].getBoundingClientRect();
    var at = { clientX: box.left + box.width / 2 + 9, clientY: box.top + box.height / 2 - 9, bubbles: true, cancelable: true };
    var picture = figure.querySelector('svg');
    picture.dispatchEvent(new PointerEvent('pointerdown', Object.assign({ pointerType: 'touch' }, at)));
    picture.dispatchEvent(new MouseEvent('click', at));
    var tip = figure.querySelector('.tip');
    var told = TOLD.test(tip.textContent);
    found.plots += 1;
    found.told += Number(told ? tip.querySelectorAll('a').length === LINKS : false);
  });
  // The smallest mark, in pixels of the screen.
  found.mark = Array.from(document.querySelectorAll('.mark')).reduce(function (least, mark) {
    return Math.min(least, mark.getBoundingClientRect().width);
  }, 1000);
  var told = document.createElement('pre');
  told.id = 'probe';
  told.textContent = JSON.stringify(found);
  document.body.appendChild(told);
});
